# SPDX-License-Identifier: Apache-2.0
enable_testing()
include(GoogleTest)
file(GLOB test_sources CONFIGURE_DEPENDS tests/*.cpp)
add_executable(tests ${test_sources})
chromeball_internal_target(tests)
target_include_directories(tests PRIVATE tests)
target_link_libraries(tests PRIVATE demo nlohmann_json::nlohmann_json OpenEXR::OpenEXR PNG::PNG
                      JPEG::JPEG Boost::headers Eigen3::Eigen GTest::gtest GTest::gtest_main)
chromeball_optimize_less(tests)
chromeball_link_library_first(tests)
chromeball_unity(tests 56)  # each file of tests has a namespace of its name
# What a third of the tests include, and parse for seconds.
set(tests_dir ${PROJECT_SOURCE_DIR}/tests)
target_precompile_headers(tests PRIVATE
  <filesystem> <fstream> <gtest/gtest.h> <fmt/format.h>
  ${PROJECT_SOURCE_DIR}/renderer/base/json.h
  ${tests_dir}/json_file.h
  ${tests_dir}/test_scene.h
  ${PROJECT_SOURCE_DIR}/renderer/image/io/read_image.h
  ${PROJECT_SOURCE_DIR}/renderer/image/io/write_image.h
  ${PROJECT_SOURCE_DIR}/renderer/scene/gltf/load_gltf.h)
set_property(SOURCE tests/paths.cpp PROPERTY COMPILE_DEFINITIONS
             CHROMEBALL_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
             CHROMEBALL_BUILD_DIR="${PROJECT_BINARY_DIR}"
             CHROMEBALL_COMMAND="$<TARGET_FILE:chromeball>"
             CHROMEBALL_COMMAND_SERVER="$<TARGET_FILE:command_server>")
add_executable(command_server tests/command_server/main.cpp)
chromeball_compile(command_server)
target_link_libraries(command_server PRIVATE command_line)
chromeball_link_library_first(command_server)
set(instrumented 0)
if(CHROMEBALL_SANITIZE)
  set(instrumented 1)
endif()
set_property(SOURCE tests/consumer_test.cpp PROPERTY COMPILE_DEFINITIONS
             CHROMEBALL_CMAKE="${CMAKE_COMMAND}" CHROMEBALL_COMPILER="${CMAKE_CXX_COMPILER}"
             CHROMEBALL_INSTALLS=$<BOOL:${CHROMEBALL_INSTALL}>
             CHROMEBALL_INSTRUMENTED=${instrumented})
add_dependencies(tests chromeball command_server)
if(TARGET make_demo)
  add_dependencies(tests make_demo)
endif()
gtest_discover_tests(tests DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)

# Not in the suite: ctest --preset package.
add_test(NAME package_release COMMAND ${PROJECT_SOURCE_DIR}/tools/scripts/release.sh CONFIGURATIONS Package)
set_tests_properties(package_release PROPERTIES LABELS package FIXTURES_SETUP release TIMEOUT 7200)
foreach(case deb tarball ubuntu dockerfile)
  add_test(NAME package_${case} COMMAND ${PROJECT_SOURCE_DIR}/tools/scripts/test_package.sh ${case}
           CONFIGURATIONS Package)
  set_tests_properties(package_${case} PROPERTIES LABELS package FIXTURES_REQUIRED release RUN_SERIAL ON
                       SKIP_RETURN_CODE 77 TIMEOUT 7200)
endforeach()
