# SPDX-License-Identifier: Apache-2.0
# Compiles the files of a folder together, in groups of about `kilobytes` of source: two thirds of the
# time of a file compiled alone go into the headers that its neighbours include too. Names without
# linkage (anonymous namespaces) are therefore unique within a folder; what a file takes from its
# neighbours by accident, a build with -DCHROMEBALL_UNITY=OFF finds (clang-tidy configures one).
# A group is the least that an edit compiles again, so that its size bounds that time.
function(chromeball_unity target kilobytes)
  if(NOT CHROMEBALL_UNITY)
    return()
  endif()
  math(EXPR limit "${kilobytes} * 1024")
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "^${PROJECT_BINARY_DIR}/")
  set(folder_before)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    file(SIZE ${source} size)
    if(NOT folder STREQUAL folder_before)
      set(folder_before ${folder})
      set(number 0)
      set(bytes 0)
    elseif(bytes GREATER limit)
      math(EXPR number "${number} + 1")
      set(bytes 0)
    endif()
    math(EXPR bytes "${bytes} + ${size}")
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE room)
    string(MAKE_C_IDENTIFIER "${room}_${number}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # a file of a group counts as a header, which it is not
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()
