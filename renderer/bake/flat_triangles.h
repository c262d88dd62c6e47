// SPDX-License-Identifier: Apache-2.0
// Triangles of a plane: distance, overlap, and a set of which none overlaps another.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "math/vec.h"

namespace chromeball {

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

// Finds overlaps with triangles added before, by a grid.
class FlatTriangleSet {
 public:
  // `cell`: about the extent of most triangles.
  explicit FlatTriangleSet(double cell) : cell_(cell) {}

  bool overlaps(const FlatTriangle& t) const;
  void add(const FlatTriangle& t);

 private:
  struct Range {
    int64_t x0, y0, x1, y1;

    bool isLarge() const;  // of too many cells
  };
  Range cellsOf(const FlatTriangle& t) const;
  bool overlapsOneOf(const FlatTriangle& t, const std::vector<uint32_t>& indices) const;

  double cell_;
  std::vector<FlatTriangle> triangles_;
  std::vector<uint32_t> large_;  // in no cell
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

}  // namespace chromeball
