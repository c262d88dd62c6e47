# SPDX-License-Identifier: Apache-2.0
# The library: chromeball_renderer here, chromeball::renderer for others.
file(GLOB_RECURSE renderer_sources CONFIGURE_DEPENDS renderer/*.cpp)
list(FILTER renderer_sources EXCLUDE REGEX "/image/imageio/")  # the module
# Folders that take no part of a render's time: what is read, planned and reported.
set(planning_sources ${renderer_sources})
list(FILTER planning_sources INCLUDE REGEX "/renderer/(description|front|session|parts|animation|study|measure|scene/gltf|scene/solve)/")
list(REMOVE_ITEM renderer_sources ${planning_sources})
add_library(chromeball_planning OBJECT ${planning_sources})
add_library(chromeball_renderer ${renderer_sources} $<TARGET_OBJECTS:chromeball_planning>)
add_library(chromeball::renderer ALIAS chromeball_renderer)
chromeball_optimize_less(chromeball_planning)
set_target_properties(chromeball_renderer PROPERTIES
  EXPORT_NAME renderer
  OUTPUT_NAME chromeball
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# The formats that only OpenImageIO reads, which load 250 libraries: a module, loaded for the first
# such file. It is found beside the library or the command, or where the former is installed, seen
# from the latter.
include(GNUInstallDirs)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_FULL_BINDIR}
           OUTPUT_VARIABLE bin_to_lib)
file(GLOB imageio_sources CONFIGURE_DEPENDS renderer/image/imageio/*.cpp)
add_library(chromeball_imageio MODULE ${imageio_sources})
chromeball_compile(chromeball_imageio)
set_target_properties(chromeball_imageio PROPERTIES CXX_VISIBILITY_PRESET hidden)
target_compile_definitions(chromeball_imageio PRIVATE CHROMEBALL_VERSION="${PROJECT_VERSION}")
target_include_directories(chromeball_imageio PRIVATE renderer)
target_link_libraries(chromeball_imageio PRIVATE PkgConfig::OpenImageIO)
add_dependencies(chromeball_renderer chromeball_imageio)
set_property(SOURCE renderer/image/io/imageio_module.cpp PROPERTY COMPILE_DEFINITIONS
             CHROMEBALL_BIN_TO_LIB="${bin_to_lib}")

set(chromeball_private_libraries
  # tinygltf before Draco: Debian's libdraco exports a tinygltf of another version, whose functions
  # would replace the ones that our calls were compiled for.
  TBB::tbb embree OpenEXR::OpenEXR PNG::PNG JPEG::JPEG PkgConfig::WebP
  TinyGLTF::TinyGLTF PkgConfig::Draco meshoptimizer::meshoptimizer PkgConfig::Blosc
  # Headers only: a static library's consumers need not find them.
  $<BUILD_INTERFACE:Eigen3::Eigen> $<BUILD_INTERFACE:Boost::headers>
  $<BUILD_INTERFACE:nlohmann_json::nlohmann_json>)
# Each takes as long as a group, for what it instantiates of a library.
set_source_files_properties(
  renderer/base/json.cpp renderer/math/dense_solvers.cpp
  renderer/relight/transfer/clustered_pca.cpp renderer/lighting/export/light_file.cpp
  renderer/lighting/fit/light_descent.cpp renderer/scene/gltf/draco.cpp
  renderer/scene/gltf/gltf_file.cpp renderer/bake/gltf_document.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
foreach(target chromeball_planning chromeball_renderer)
  chromeball_compile(${target})
  # GLM's definitions decide what its vectors declare, so consumers need the same.
  target_compile_definitions(${target}
    PUBLIC GLM_FORCE_SILENT_WARNINGS GLM_FORCE_XYZW_ONLY
    PRIVATE CHROMEBALL_VERSION="${PROJECT_VERSION}")
  target_include_directories(${target} PRIVATE renderer)
  target_include_directories(${target} SYSTEM PRIVATE ${EMBREE_INCLUDE_DIRS})
  target_link_libraries(${target} PUBLIC fmt::fmt glm::glm PRIVATE ${chromeball_private_libraries})
  # What nearly every file includes, parsed once.
  target_precompile_headers(${target} PRIVATE
    <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional> <span> <string> <vector>
    <fmt/format.h> <glm/glm.hpp> <glm/gtc/quaternion.hpp>)
endforeach()
chromeball_unity(chromeball_planning 20)
chromeball_unity(chromeball_renderer 24)
# A static library may become a part of a module, as of Python's, and keep its names to itself; without
# hidden names, code that is independent of its position is slower.
set_target_properties(chromeball_planning chromeball_renderer PROPERTIES POSITION_INDEPENDENT_CODE ON)
if(NOT BUILD_SHARED_LIBS)
  set_target_properties(chromeball_planning chromeball_renderer PROPERTIES
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endif()

# The page of a comparison and its script become strings.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
             renderer/study/report/report.html renderer/study/report/report.js)
file(READ renderer/study/report/report.html report_html)
file(READ renderer/study/report/report.js report_script)
configure_file(renderer/study/report/embedded.cpp.in report_embedded.cpp @ONLY)
target_sources(chromeball_renderer PRIVATE ${PROJECT_BINARY_DIR}/report_embedded.cpp)

# Headers for consumers, who write #include <chromeball/film/film.h>. They are copies, in which
# "math/vec.h" reads <chromeball/math/vec.h>, so that renderer/ itself is on nobody else's path.
# Consumers in the same build (add_subdirectory) and the install step take the same copies.
set(chromeball_include_dir ${PROJECT_BINARY_DIR}/include)
file(GLOB_RECURSE renderer_headers CONFIGURE_DEPENDS renderer/*.h)
add_custom_command(
  OUTPUT ${PROJECT_BINARY_DIR}/public_headers.stamp
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR}/renderer
          -DDESTINATION=${chromeball_include_dir}/chromeball
          -P ${PROJECT_SOURCE_DIR}/tools/cmake/public_headers.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${PROJECT_BINARY_DIR}/public_headers.stamp
  DEPENDS ${renderer_headers} ${PROJECT_SOURCE_DIR}/tools/cmake/public_headers.cmake
  COMMENT "Copying the public headers"
  VERBATIM)
add_custom_target(chromeball_headers DEPENDS ${PROJECT_BINARY_DIR}/public_headers.stamp)
add_dependencies(chromeball_renderer chromeball_headers)
target_include_directories(chromeball_renderer INTERFACE $<BUILD_INTERFACE:${chromeball_include_dir}>)
