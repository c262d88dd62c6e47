// SPDX-License-Identifier: Apache-2.0
#include "scene/outside_view.h"

#include <algorithm>

#include "base/parallel.h"
#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

void addInstance(const Scene& scene, const Instance& instance, const OutsideViews& empty,
                 OutsideViews& views) {
  constexpr size_t kGrain = 1 << 18;
  const auto addTriangles = [&](size_t begin, size_t end, OutsideViews& to) {
    forTriangles(scene, instance, begin, end, [&](const Corners& c) {
      for (AxisView& view : to) view.add(c);
    });
  };
  const auto join = [](OutsideViews& to, const OutsideViews& later) {
    for (size_t i = 0; i < to.size(); ++i) to[i].add(later[i]);
  };
  const size_t count = triangleCount(scene, instance);
  if (count <= kGrain)
    addTriangles(0, count, views);
  else
    join(views, joinRanges(count, kGrain, empty, addTriangles, join));
}

}  // namespace

void AxisView::add(const Corners& corners) {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  std::array<dvec2, 3> p;  // u, v and the axis are right-handed
  for (size_t k = 0; k < 3; ++k) {
    const dvec3 corner = toCells(corners[k]);
    p[k] = {corner[u], corner[v]};
  }
  const dvec2 low = glm::min(p[0], glm::min(p[1], p[2])),
              high = glm::max(p[0], glm::max(p[1], p[2]));
  // The first cell whose centre may be covered.
  const dvec2 first = glm::clamp(glm::ceil(low - 0.5), dvec2(0), dvec2(kCells));
  if (!(first.x + 0.5 <= high.x && first.y + 0.5 <= high.y)) return;
  const double area = cross(p[1] - p[0], p[2] - p[0]);  // > 0: faces the upper side
  if (area == 0) return;
  for (int y = int(first.y); y < kCells && y + 0.5 <= high.y; ++y)
    for (int x = int(first.x); x < kCells && x + 0.5 <= high.x; ++x) {
      const dvec2 at(x + 0.5, y + 0.5);
      const double a = cross(p[1] - at, p[2] - at) / area, b = cross(p[2] - at, p[0] - at) / area;
      if (a < 0 || b < 0 || a + b > 1) continue;
      const double height =
          a * corners[0][axis_] + b * corners[1][axis_] + (1 - a - b) * corners[2][axis_];
      Cell& nearest = cells_[size_t(y * kCells + x)];
      if (height > nearest.high) nearest.high = height, nearest.highIsFront = area > 0;
      if (height < nearest.low) nearest.low = height, nearest.lowIsFront = area < 0;
    }
}

void AxisView::add(const AxisView& later) {
  for (size_t i = 0; i < cells_.size(); ++i) {
    const Cell& other = later.cells_[i];
    Cell& nearest = cells_[i];
    if (other.high > nearest.high)
      nearest.high = other.high, nearest.highIsFront = other.highIsFront;
    if (other.low < nearest.low) nearest.low = other.low, nearest.lowIsFront = other.lowIsFront;
  }
}

void AxisView::count(double& backFaces, double& faces) const {
  for (const Cell& nearest : cells_) {
    if (nearest.high < nearest.low) continue;
    faces += 2;
    backFaces += !nearest.highIsFront + !nearest.lowIsFront;
  }
}

bool AxisView::shows(const dvec3& point, bool fromUpperSide) const {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  const dvec3 at = toCells(point);
  const int x = std::clamp(int(at[u]), 0, kCells - 1), y = std::clamp(int(at[v]), 0, kCells - 1);
  const double near = 2 * std::max(1 / cellsPerMetre_[u], 1 / cellsPerMetre_[v]);
  const Cell& nearest = cells_[size_t(y * kCells + x)];
  return fromUpperSide ? nearest.high <= point[axis_] + near : nearest.low >= point[axis_] - near;
}

OutsideViews outsideViews(const Scene& scene, const std::vector<int>& instances,
                          const Bounds& box) {
  const OutsideViews empty{AxisView(0, box), AxisView(1, box), AxisView(2, box)};
  OutsideViews views = empty;
  for (const int i : instances) addInstance(scene, scene.instances[size_t(i)], empty, views);
  return views;
}

bool faceInwards(const OutsideViews& views) {
  constexpr double kMinFraction = 0.6;
  double backFaces = 0, faces = 0;
  for (const AxisView& view : views) view.count(backFaces, faces);
  return backFaces > kMinFraction * faces;
}

}  // namespace chromeball
