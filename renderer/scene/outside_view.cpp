// SPDX-License-Identifier: Apache-2.0
#include "scene/outside_view.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>

#include "scene/placed_triangles.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kCells = 64;  // per side of OutsideView's grid

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

// A triangle, also in units of the cells of OutsideView's grids: of the axes' extents / kCells.
struct GridTriangle {
  GridTriangle(const Corners& c, const dvec3& o, const dvec3& scale)
      : corners(c), origin(o), cellsPerMetre(scale) {
    const dvec3 low = toCells(glm::min(c[0], glm::min(c[1], c[2])));
    high = toCells(glm::max(c[0], glm::max(c[1], c[2])));
    first = glm::clamp(glm::ceil(low - 0.5), dvec3(0), dvec3(kCells));
  }

  dvec3 toCells(const dvec3& point) const { return (point - origin) * cellsPerMetre; }
  bool meetsCells(int axis) const { return first[axis] + 0.5 <= high[axis]; }

  const Corners& corners;
  const dvec3 &origin, &cellsPerMetre;
  dvec3 first, high;  // index of the first cell whose centre may be covered; the upper bound
};

// The nearest surfaces seen along one axis, from both sides of the bounding box, sampled by a grid
// of kCells^2 parallel rays.
class OutsideView {
 public:
  explicit OutsideView(int axis) : axis_(axis) {}

  void add(const GridTriangle& triangle) {
    const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
    if (!triangle.meetsCells(u) || !triangle.meetsCells(v)) return;
    std::array<dvec2, 3> p;  // u, v and the axis are right-handed
    for (size_t k = 0; k < 3; ++k) {
      const dvec3 corner = triangle.toCells(triangle.corners[k]);
      p[k] = {corner[u], corner[v]};
    }
    const double area = cross(p[1] - p[0], p[2] - p[0]);  // > 0: faces the upper side
    if (area == 0) return;
    const Corners& corners = triangle.corners;
    for (int y = int(triangle.first[v]); y < kCells && y + 0.5 <= triangle.high[v]; ++y)
      for (int x = int(triangle.first[u]); x < kCells && x + 0.5 <= triangle.high[u]; ++x) {
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

  // Adds what a view with later triangles shows; of surfaces at one height the first counts.
  void add(const OutsideView& later) {
    for (size_t i = 0; i < cells_.size(); ++i) {
      const Cell& other = later.cells_[i];
      Cell& nearest = cells_[i];
      if (other.high > nearest.high)
        nearest.high = other.high, nearest.highIsFront = other.highIsFront;
      if (other.low < nearest.low) nearest.low = other.low, nearest.lowIsFront = other.lowIsFront;
    }
  }

  // Adds the number of back faces and of all faces that are visible in the two views.
  void count(double& backFaces, double& faces) const {
    for (const Cell& nearest : cells_) {
      if (nearest.high < nearest.low) continue;
      faces += 2;
      backFaces += !nearest.highIsFront + !nearest.lowIsFront;
    }
  }

 private:
  struct Cell {
    double high = -INFINITY, low = INFINITY;
    bool highIsFront = true, lowIsFront = true;
  };
  int axis_;
  std::vector<Cell> cells_ = std::vector<Cell>(size_t(kCells) * kCells);
};

using OutsideViews = std::array<OutsideView, 3>;

void addInstance(const Scene& scene, const Instance& instance, const Bounds& box,
                 const OutsideViews& empty, OutsideViews& views) {
  constexpr size_t kGrain = 1 << 18;
  const dvec3 origin(box.min), cellsPerMetre = double(kCells) / box.size();
  const auto withTriangles = [&](const tbb::blocked_range<size_t>& range, OutsideViews to) {
    forTriangles(scene, instance, range.begin(), range.end(), [&](const Corners& c) {
      const GridTriangle triangle(c, origin, cellsPerMetre);
      for (OutsideView& view : to) view.add(triangle);
    });
    return to;
  };
  const auto joined = [](OutsideViews to, const OutsideViews& later) {
    for (size_t i = 0; i < to.size(); ++i) to[i].add(later[i]);
    return to;
  };
  const tbb::blocked_range<size_t> all(0, triangleCount(scene, instance), kGrain);
  views = all.size() <= kGrain
              ? withTriangles(all, std::move(views))
              : joined(std::move(views), tbb::parallel_reduce(all, empty, withTriangles, joined));
}

}  // namespace

bool facesInwards(const Scene& scene, const std::vector<int>& instances, const Bounds& box) {
  constexpr double kMinFraction = 0.6;
  const OutsideViews empty{OutsideView(0), OutsideView(1), OutsideView(2)};
  OutsideViews views = empty;
  for (const int i : instances) addInstance(scene, scene.instances[size_t(i)], box, empty, views);
  double backFaces = 0, faces = 0;
  for (const OutsideView& view : views) view.count(backFaces, faces);
  return backFaces > kMinFraction * faces;
}

}  // namespace chromeball
