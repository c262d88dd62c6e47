// SPDX-License-Identifier: Apache-2.0
// The geometry that the points of vertices make.
#pragma once

#include "bake/bake_points.h"
#include "bake/baked_geometry.h"

namespace chromeball {

// By instance: its vertices, in the order of vertexPoints(), and the triangles between them.
std::vector<BakedGeometry> vertexGeometry(const std::vector<PlacedMesh>& meshes,
                                          const std::vector<BakePoint>& points);

// Of an instance: vertices without light take the mean of those that they share edges with, from
// the edge of the lit part inwards.
void fillVertices(const std::vector<Triangle>& triangles, std::vector<Rgb>& light,
                  std::vector<uint8_t> isLit);

}  // namespace chromeball
