# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=renderer -DDESTINATION=include/chromeball -P public_headers.cmake
# Copies the public headers: all of renderer/api/, as <chromeball/session.h>, and what they include,
# with #include "math/vec.h" turned into #include <chromeball/math/vec.h>. None may include a library
# that only the renderer's own sources use, or have vector types, which need the renderer's
# instruction set.
cmake_minimum_required(VERSION 3.22)
set(private_libraries "<(embree|OpenImageIO/|OpenEXR/|png\\.h|jpeglib\\.h|tiny_gltf|toml\\+\\+/|nlohmann/|webp/|draco/|meshoptimizer|Eigen/|boost/|tbb/|blosc|xxhash)")

file(GLOB open RELATIVE ${SOURCE} ${SOURCE}/api/*.h)
set(headers)
while(open)
  list(POP_FRONT open header)
  if(header IN_LIST headers)
    continue()
  endif()
  list(APPEND headers ${header})
  file(READ ${SOURCE}/${header} text)
  if(text MATCHES "# *include ${private_libraries}" OR text MATCHES "vector_size\\(")
    message(FATAL_ERROR "renderer/${header} is public, and includes a library that is not")
  endif()
  string(REGEX MATCHALL "#include \"[^\"\n]+\"" included "${text}")
  list(TRANSFORM included REPLACE "#include \"(.*)\"" "\\1")
  list(APPEND open ${included})
endwhile()

file(GLOB_RECURSE stale RELATIVE ${DESTINATION} ${DESTINATION}/*.h)
foreach(header ${headers})
  string(REGEX REPLACE "^api/" "" name ${header})
  list(REMOVE_ITEM stale ${name})
  file(READ ${SOURCE}/${header} text)
  string(REGEX REPLACE "#include \"(api/)?([^\"\n]+)\"" "#include <chromeball/\\2>" text "${text}")
  set(existing)
  if(EXISTS ${DESTINATION}/${name})
    file(READ ${DESTINATION}/${name} existing)
  endif()
  if(NOT text STREQUAL existing)  # an unchanged header causes no recompilation
    file(WRITE ${DESTINATION}/${name} "${text}")
  endif()
endforeach()
foreach(header ${stale})
  file(REMOVE ${DESTINATION}/${header})
endforeach()
