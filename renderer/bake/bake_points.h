// SPDX-License-Identifier: Apache-2.0
// The points of surfaces where light is baked: an atlas's texels, or vertices.
#pragma once

#include "bake/atlas.h"

namespace chromeball {

struct BakePoint {
  uint32_t x, y;  // the texel; or the vertex and the instance
  int chart;      // index of the chart, or of the instance
  int instance;
  uint32_t triangle;
  vec2 barycentric;  // weights of the second and third vertex
  float extent;      // of the texel, or of the triangle's smallest edges: metres
};

// One point for each texel that a chart touches, by charts and rows: the surface at the texel's
// centre or, where that is beyond the chart's edge, the nearest point of the chart. Points keep off
// the edges of triangles, where a ray might start in a wall that meets them.
std::vector<BakePoint> texelPoints(const std::vector<PlacedMesh>& meshes,
                                   const std::vector<Chart>& charts, const Atlas& atlas);

// One point for each vertex of a triangle with an area: in the vertex's largest triangle, near the
// vertex.
std::vector<BakePoint> vertexPoints(const std::vector<PlacedMesh>& meshes);

}  // namespace chromeball
