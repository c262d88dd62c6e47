// SPDX-License-Identifier: Apache-2.0
#include "bake/flat_triangles.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

struct Interval {
  double min, max;
};

Interval projected(const FlatTriangle& t, const glm::dvec2& axis) {
  const double a = glm::dot(t[0], axis), b = glm::dot(t[1], axis), c = glm::dot(t[2], axis);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

// Whether an edge of `a` has all of `b` on its other side.
bool separates(const FlatTriangle& a, const FlatTriangle& b, double tolerance) {
  for (int side = 0; side < 3; ++side) {
    const glm::dvec2 edge = a[size_t(side + 1) % 3] - a[size_t(side)];
    const double length = glm::length(edge);
    if (!(length > 0)) continue;
    const glm::dvec2 axis = glm::dvec2(-edge.y, edge.x) / length;
    const Interval ofA = projected(a, axis), ofB = projected(b, axis);
    if (std::min(ofA.max, ofB.max) - std::max(ofA.min, ofB.min) <= tolerance) return true;
  }
  return false;
}

uint64_t cellKey(int64_t x, int64_t y) { return uint64_t(x) << 32 ^ uint64_t(uint32_t(y)); }

}  // namespace

bool overlap(const FlatTriangle& a, const FlatTriangle& b, double tolerance) {
  return !separates(a, b, tolerance) && !separates(b, a, tolerance);
}

NearestPoint nearestPoint(const FlatTriangle& t, const glm::dvec2& p) {
  const double area = cross(t[1] - t[0], t[2] - t[0]);
  const double b = cross(p - t[0], t[2] - t[0]) / area, c = cross(t[1] - t[0], p - t[0]) / area;
  if (b >= 0 && c >= 0 && b + c <= 1) return {vec2(b, c), 0};
  NearestPoint nearest{vec2(0), INFINITY};
  for (int side = 0; side < 3; ++side) {
    const size_t from = size_t(side), to = size_t(side + 1) % 3;
    const glm::dvec2 edge = t[to] - t[from];
    const double length2 = glm::dot(edge, edge);
    const double along =
        length2 > 0 ? std::clamp(glm::dot(p - t[from], edge) / length2, 0.0, 1.0) : 0;
    const glm::dvec2 apart = p - (t[from] + along * edge);
    const double distance2 = glm::dot(apart, apart);
    if (!(distance2 < nearest.distance2)) continue;
    vec3 weights(0);
    weights[int(from)] = float(1 - along);
    weights[int(to)] = float(along);
    nearest = {vec2(weights.y, weights.z), distance2};
  }
  return nearest;
}

bool FlatTriangleSet::Range::isLarge() const {
  constexpr double kMaxCells = 1024;
  return double(x1 - x0 + 1) * double(y1 - y0 + 1) > kMaxCells;
}

FlatTriangleSet::Range FlatTriangleSet::cellsOf(const FlatTriangle& t) const {
  const Interval x = projected(t, {1, 0}), y = projected(t, {0, 1});
  constexpr double kMost = 1e9;  // of cells from the origin; those beyond share cells
  const auto cell = [&](double at) {
    return int64_t(std::clamp(std::floor(at / cell_), -kMost, kMost));
  };
  return {cell(x.min), cell(y.min), cell(x.max), cell(y.max)};
}

bool FlatTriangleSet::overlapsOneOf(const FlatTriangle& t,
                                    const std::vector<uint32_t>& indices) const {
  constexpr double kTolerance = 1e-5;  // of the smaller one's extent
  const auto extent = [](const FlatTriangle& f) {
    const Interval x = projected(f, {1, 0}), y = projected(f, {0, 1});
    return std::max(x.max - x.min, y.max - y.min);
  };
  return std::ranges::any_of(indices, [&](uint32_t i) {
    const FlatTriangle& other = triangles_[i];
    return overlap(t, other, kTolerance * std::min(extent(t), extent(other)));
  });
}

bool FlatTriangleSet::overlaps(const FlatTriangle& t) const {
  if (overlapsOneOf(t, large_)) return true;
  const Range range = cellsOf(t);
  if (range.isLarge())
    return std::ranges::any_of(cells_,
                               [&](const auto& cell) { return overlapsOneOf(t, cell.second); });
  for (int64_t y = range.y0; y <= range.y1; ++y)
    for (int64_t x = range.x0; x <= range.x1; ++x) {
      const auto cell = cells_.find(cellKey(x, y));
      if (cell != cells_.end() && overlapsOneOf(t, cell->second)) return true;
    }
  return false;
}

void FlatTriangleSet::add(const FlatTriangle& t) {
  const uint32_t index = uint32_t(triangles_.size());
  triangles_.push_back(t);
  const Range range = cellsOf(t);
  if (range.isLarge()) return large_.push_back(index);
  for (int64_t y = range.y0; y <= range.y1; ++y)
    for (int64_t x = range.x0; x <= range.x1; ++x) cells_[cellKey(x, y)].push_back(index);
}

}  // namespace chromeball
