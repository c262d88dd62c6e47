# SPDX-License-Identifier: Apache-2.0
# How this project's own targets are compiled and linked. Projects that link chromeball::renderer
# inherit none of these options: no public header's layout depends on them (GLM is used without its
# SIMD types; Eigen and Embree do not occur in public headers).

# NaN keeps its meaning: no -ffast-math. The two flags below change no result: maths functions need
# not set errno, and floating-point operations need not keep the order in which they would trap.
set(chromeball_compile_options
    -march=${CHROMEBALL_ARCH} -fno-math-errno -fno-trapping-math
    -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers)
set(chromeball_link_options)

# Links in half the time of GNU ld.
if(NOT CHROMEBALL_SANITIZE AND NOT CHROMEBALL_FUZZ)
  include(CheckLinkerFlag)
  check_linker_flag(CXX -fuse-ld=gold CHROMEBALL_HAS_GOLD)
  if(CHROMEBALL_HAS_GOLD)
    list(APPEND chromeball_link_options -fuse-ld=gold)
  endif()
endif()

if(CHROMEBALL_WERROR)
  list(APPEND chromeball_compile_options -Werror)
endif()
if(CHROMEBALL_SANITIZE)  # -fno-sanitize-recover: a finding of UBSan fails the test that caused it
  list(APPEND chromeball_compile_options -fsanitize=${CHROMEBALL_SANITIZE}
       -fno-sanitize-recover=undefined,float-cast-overflow -fno-omit-frame-pointer)
  list(APPEND chromeball_link_options -fsanitize=${CHROMEBALL_SANITIZE})
endif()
if(CHROMEBALL_FUZZ)
  list(APPEND chromeball_compile_options
       -fsanitize=fuzzer-no-link,address,undefined,float-cast-overflow
       -fno-sanitize-recover=undefined,float-cast-overflow -fno-omit-frame-pointer
       -fsanitize-ignorelist=${PROJECT_SOURCE_DIR}/tests/fuzz/ignored.txt)
  list(APPEND chromeball_link_options -fsanitize=address,undefined,float-cast-overflow)
endif()

# GCC without optimisation rejects Eigen's use of intrinsics where headers are precompiled.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Debug")
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# GCC 12 warns wrongly of code in {fmt} 9 and in its own std::string (GCC bugs 105651 and 105329).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  list(APPEND chromeball_compile_options -Wno-restrict -Wno-stringop-overflow)
endif()

# GCC collects garbage while it compiles from 128 MB on; without, a group of files takes a tenth less
# time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND chromeball_compile_options --param=ggc-min-heapsize=1048576)
endif()

# GCC copies and clears structures of 32 to 8192 bytes by `rep` instructions, which take some 30 cycles
# to begin. By vectors instead, a render takes a twentieth less time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  set(strategy vector_loop:1024:noalign,libcall:-1:noalign)
  list(APPEND chromeball_compile_options -mmemcpy-strategy=${strategy} -mmemset-strategy=${strategy})
endif()

function(chromeball_compile target)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${chromeball_compile_options})
  target_link_options(${target} PRIVATE ${chromeball_link_options})
endfunction()

# Code that takes no part in a render's time (options, reports, tests): -O1 would cost a quarter more of
# the time to compile, -O3 two thirds more, and gain nothing.
function(chromeball_optimize_less target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Og>)
endfunction()

# A target of this project that uses the library's sources by their paths from renderer/.
function(chromeball_internal_target target)
  chromeball_compile(${target})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/renderer)
  target_compile_definitions(${target} PRIVATE CHROMEBALL_VERSION="${PROJECT_VERSION}")
  target_link_libraries(${target} PRIVATE chromeball_renderer)
endfunction()

# Links the static library before a program's own objects: of an inline function that both have a copy of, the
# linker takes the first, and the program's may be compiled with -Og. So all programs of a build give the same bits.
function(chromeball_link_library_first target)
  if(NOT BUILD_SHARED_LIBS)
    target_link_options(${target} BEFORE PRIVATE
      -Wl,--whole-archive $<TARGET_FILE:chromeball_renderer> -Wl,--no-whole-archive)
  endif()
endfunction()
