// SPDX-License-Identifier: Apache-2.0
// An atlas: surfaces in charts, connected parts that are nearly flat, each projected to a plane,
// and the places of charts on a square page of texels.
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

// The places of charts.

inline constexpr int kMaxPage = 16384;  // texels along an edge

// A chart's texels with the padding around them.
struct AtlasPlace {
  int x, y, width, height;
};

struct Atlas {
  int size = 0;        // of the page, in texels
  int padding = 0;     // texels around each chart
  double density = 0;  // texels per metre
  std::vector<AtlasPlace> places;

  // The texel coordinates of a point of a chart. The edges of its rectangle go through the centres
  // of texels, so that bilinear filtering within the chart reads no other texels.
  glm::dvec2 toPage(size_t chart, const glm::dvec2& point) const {
    const AtlasPlace& place = places[chart];
    return glm::dvec2(place.x + padding, place.y + padding) + 0.5 + density * point;
  }
};

// The highest density, up to a factor of 1.001, of a page of a given size. Throws InputError, begun
// by `location`, if the charts do not fit at any density.
Atlas fitAtlas(const std::vector<Chart>& charts, int size, int padding,
               const std::string& location);

// The smallest page, whose size is a power of two, for texels of this many metres. Throws
// InputError, begun by `location`, if it would have more than kMaxPage texels.
Atlas atlasOfTexels(const std::vector<Chart>& charts, double metres, int padding,
                    const std::string& location);

}  // namespace chromeball
