# SPDX-License-Identifier: Apache-2.0
# A fuzz target reads its seeds first; `ctest -L fuzz` runs each for a minute. OpenImageIO keeps
# error messages for ever, so leaks are not reported.
enable_testing()
file(GLOB fuzz_sources CONFIGURE_DEPENDS tests/fuzz/*.cpp)
foreach(source ${fuzz_sources})
  cmake_path(GET source STEM name)
  add_executable(fuzz_${name} ${source})
  chromeball_internal_target(fuzz_${name})
  target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/corpus/${name})  # where the fuzzer keeps what it finds
  add_test(NAME fuzz_${name} COMMAND fuzz_${name} -max_total_time=60 -timeout=10 -rss_limit_mb=2048
           -malloc_limit_mb=1024 -max_len=65536 -detect_leaks=0
           corpus/${name} ${PROJECT_SOURCE_DIR}/tests/fuzz/seeds/${name})
  set_tests_properties(fuzz_${name} PROPERTIES LABELS fuzz TIMEOUT 120 ENVIRONMENT
                       "ASAN_OPTIONS=detect_leaks=0;OPENIMAGEIO_OPTIONS=threads=1")
endforeach()
