// SPDX-License-Identifier: Apache-2.0
// Divides surfaces into charts: connected parts that are nearly flat, each projected to a plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bake/placed_mesh.h"
#include "math/vec.h"

namespace chromeball {

// Triangles of a plane.

using FlatTriangle = std::array<glm::dvec2, 3>;

// Whether the interiors of the triangles have a point in common. A depth of less than `tolerance`
// does not count.
bool overlap(const FlatTriangle& a, const FlatTriangle& b, double tolerance);

struct NearestPoint {
  vec2 barycentric;  // weights of the second and third corner
  double distance2;  // 0 inside
};

// The point of a triangle, which must have an area, that is nearest to p.
NearestPoint nearestPoint(const FlatTriangle& t, const glm::dvec2& p);

// The orthogonal projection to a plane, in metres, from (0, 0) to `size`; no two triangles overlap.
struct Chart {
  int instance = 0;
  std::vector<uint32_t> triangles;  // of the instance's mesh
  glm::dvec3 origin{0}, axisU{1, 0, 0}, axisV{0, 1, 0};
  glm::dvec2 size{0};

  glm::dvec2 project(const glm::dvec3& p) const {
    return {glm::dot(p - origin, axisU), glm::dot(p - origin, axisV)};
  }
  FlatTriangle project(const PlacedMesh& placed, uint32_t triangle) const {
    const Triangle& t = placed.triangle(triangle);
    return {project(placed.positions[t.x]), project(placed.positions[t.y]),
            project(placed.positions[t.z])};
  }
};

// Charts grow from the largest triangles over edges that are not creases, as long as the triangles'
// normals stay near the first one's. Every triangle that has an area is in exactly one. The
// directions of the axes make the rectangles small, and at least as wide as high.
std::vector<Chart> makeCharts(const PlacedMesh& placed);

}  // namespace chromeball
