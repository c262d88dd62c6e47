# SPDX-License-Identifier: Apache-2.0
# Libraries of others. chromeball-config.cmake.in repeats those that a consumer needs.
find_package(fmt REQUIRED)
find_package(glm REQUIRED)

find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
find_package(OpenEXR CONFIG REQUIRED)
find_package(PNG REQUIRED)
find_package(JPEG REQUIRED)
find_package(PkgConfig REQUIRED)
# Used only by the module that reads TIFF. Debian's CMake package of OpenImageIO also requires its
# programs and Python module; the file for pkg-config requires the library alone.
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
pkg_check_modules(WebP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(Draco REQUIRED IMPORTED_TARGET draco)
pkg_check_modules(Blosc REQUIRED IMPORTED_TARGET blosc)
find_package(meshoptimizer CONFIG REQUIRED)
find_package(TBB REQUIRED)
find_package(TinyGLTF REQUIRED)

# Headers only
find_package(Eigen3 REQUIRED)
find_package(Boost REQUIRED)  # Math's distributions
find_package(nlohmann_json REQUIRED)
pkg_check_modules(XxHash REQUIRED libxxhash)

if(NOT CHROMEBALL_FUZZ AND (CHROMEBALL_COMMAND OR CHROMEBALL_TESTS))
  find_package(CLI11 REQUIRED)
  pkg_check_modules(HttpLib REQUIRED IMPORTED_TARGET cpp-httplib)
endif()
if(NOT CHROMEBALL_FUZZ AND CHROMEBALL_TESTS)
  find_package(GTest REQUIRED)
endif()
if(NOT CHROMEBALL_FUZZ AND CHROMEBALL_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
