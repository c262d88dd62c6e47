# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=renderer -DDESTINATION=include/chromeball -P public_headers.cmake
# Copies the public headers, with #include "math/vec.h" turned into #include <chromeball/math/vec.h>.
# A header is public unless it includes, itself or through another of ours, a library that only the
# renderer's own sources use, or has vector types, which need the renderer's instruction set.
cmake_minimum_required(VERSION 3.22)
set(private_libraries "<(embree|OpenImageIO/|OpenEXR/|png\\.h|jpeglib\\.h|tiny_gltf|toml\\+\\+/|nlohmann/|webp/|draco/|meshoptimizer|Eigen/|boost/|tbb/)")

file(GLOB_RECURSE headers RELATIVE ${SOURCE} ${SOURCE}/*.h)
foreach(header ${headers})
  file(READ ${SOURCE}/${header} text)
  string(REGEX MATCHALL "#include \"[^\"\n]+\"" includes_${header} "${text}")
  list(TRANSFORM includes_${header} REPLACE "#include \"(.*)\"" "\\1")
  if(text MATCHES "# *include ${private_libraries}" OR text MATCHES "vector_size\\(")
    set(private_${header} TRUE)
  endif()
endforeach()

# Headers that include private ones are private, and so on until no more are found.
set(changed TRUE)
while(changed)
  set(changed FALSE)
  foreach(header ${headers})
    foreach(included ${includes_${header}})
      if(private_${included} AND NOT private_${header})
        set(private_${header} TRUE)
        set(changed TRUE)
      endif()
    endforeach()
  endforeach()
endwhile()

file(GLOB_RECURSE stale RELATIVE ${DESTINATION} ${DESTINATION}/*.h)
foreach(header ${headers})
  if(private_${header})
    continue()
  endif()
  list(REMOVE_ITEM stale ${header})
  file(READ ${SOURCE}/${header} text)
  string(REGEX REPLACE "#include \"([^\"\n]+)\"" "#include <chromeball/\\1>" text "${text}")
  set(existing)
  if(EXISTS ${DESTINATION}/${header})
    file(READ ${DESTINATION}/${header} existing)
  endif()
  if(NOT text STREQUAL existing)  # an unchanged header causes no recompilation
    file(WRITE ${DESTINATION}/${header} "${text}")
  endif()
endforeach()
foreach(header ${stale})
  file(REMOVE ${DESTINATION}/${header})
endforeach()
