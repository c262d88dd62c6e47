// SPDX-License-Identifier: Apache-2.0
#include "bake/atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace chromeball {
namespace {

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

namespace {

// Finds overlaps with triangles added before, by a grid.
class FlatTriangleSet {
 public:
  // `cell`: about the extent of most triangles.
  explicit FlatTriangleSet(double cell) : cell_(cell) {}

  bool overlaps(const FlatTriangle& t) const {
    if (overlapsOneOf(t, large_)) return true;
    const Range range = cellsOf(t);
    if (range.isLarge())
      return std::ranges::any_of(cells_,
                                 [&](const auto& cell) { return overlapsOneOf(t, cell.second); });
    for (int64_t y = range.y0; y <= range.y1; ++y)
      for (int64_t x = range.x0; x <= range.x1; ++x) {
        const auto cell = cells_.find(key(x, y));
        if (cell != cells_.end() && overlapsOneOf(t, cell->second)) return true;
      }
    return false;
  }

  void add(const FlatTriangle& t) {
    const uint32_t index = uint32_t(triangles_.size());
    triangles_.push_back(t);
    const Range range = cellsOf(t);
    if (range.isLarge()) return large_.push_back(index);
    for (int64_t y = range.y0; y <= range.y1; ++y)
      for (int64_t x = range.x0; x <= range.x1; ++x) cells_[key(x, y)].push_back(index);
  }

 private:
  struct Range {
    int64_t x0, y0, x1, y1;

    bool isLarge() const {  // of too many cells
      constexpr double kMaxCells = 1024;
      return double(x1 - x0 + 1) * double(y1 - y0 + 1) > kMaxCells;
    }
  };

  static uint64_t key(int64_t x, int64_t y) { return uint64_t(x) << 32 ^ uint64_t(uint32_t(y)); }

  Range cellsOf(const FlatTriangle& t) const {
    const Interval x = projected(t, {1, 0}), y = projected(t, {0, 1});
    constexpr double kMost = 1e9;  // of cells from the origin; those beyond share cells
    const auto cell = [&](double at) {
      return int64_t(std::clamp(std::floor(at / cell_), -kMost, kMost));
    };
    return {cell(x.min), cell(y.min), cell(x.max), cell(y.max)};
  }

  bool overlapsOneOf(const FlatTriangle& t, const std::vector<uint32_t>& indices) const {
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

  double cell_;
  std::vector<FlatTriangle> triangles_;
  std::vector<uint32_t> large_;  // in no cell
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

// Largest angles. kChartAngle: between a triangle's normal and the first triangle's, so that the
// projection shrinks no direction to less than 0.77. kCreaseAngle: between the shading normals on
// both sides of an edge; more is a crease, which light does not cross smoothly.
constexpr double kChartAngle = 40, kCreaseAngle = 20;  // degrees
const double kChartCosine = std::cos(kChartAngle * kPiD / 180);
const double kCreaseCosine = std::cos(kCreaseAngle * kPiD / 180);

int cornerAt(const PlacedMesh& placed, uint32_t triangle, const glm::dvec3& position) {
  for (int corner = 0; corner < 3; ++corner)
    if (placed.positions[placed.triangle(triangle)[corner]] == position) return corner;
  return 0;
}

bool isCrease(const PlacedMesh& placed, uint32_t a, int side, uint32_t b) {
  for (const int corner : {side, (side + 1) % 3}) {
    const glm::dvec3 position = placed.positions[placed.triangle(a)[corner]];
    const glm::dvec3 other = placed.shadingNormal(b, cornerAt(placed, b, position));
    if (!(glm::dot(placed.shadingNormal(a, corner), other) >= kCreaseCosine)) return true;
  }
  return false;
}

class ChartMaker {
 public:
  explicit ChartMaker(const PlacedMesh& placed)
      : placed_(placed), isTaken_(placed.triangleCount()) {
    double sum = 0;
    size_t count = 0;
    for (const double area : placed.areas) sum += std::sqrt(area), count += area > 0;
    cell_ = count > 0 ? 2 * sum / double(count) : 1;
  }

  std::vector<Chart> make() {
    std::vector<uint32_t> seeds(placed_.triangleCount());
    std::iota(seeds.begin(), seeds.end(), 0u);
    std::ranges::stable_sort(
        seeds, [&](uint32_t a, uint32_t b) { return placed_.areas[a] > placed_.areas[b]; });
    std::vector<Chart> charts;
    for (const uint32_t seed : seeds)
      if (!isTaken_[seed] && placed_.hasArea(seed)) charts.push_back(grow(seed));
    return charts;
  }

 private:
  Chart grow(uint32_t seed) {
    Chart chart;
    chart.instance = placed_.instance;
    chart.origin = placed_.positions[placed_.triangle(seed).x];
    const glm::dvec3 normal = placed_.normals[seed];
    const Frame frame{vec3(normal)};
    chart.axisU = glm::normalize(glm::cross(glm::dvec3(frame.y), normal));
    chart.axisV = glm::cross(normal, chart.axisU);

    FlatTriangleSet taken(cell_);
    const auto take = [&](uint32_t triangle) {
      chart.triangles.push_back(triangle);
      taken.add(chart.project(placed_, triangle));
      isTaken_[triangle] = 1;
    };
    take(seed);
    for (size_t i = 0; i < chart.triangles.size(); ++i) {
      const uint32_t triangle = chart.triangles[i];
      for (int side = 0; side < 3; ++side) {
        const uint32_t next = placed_.neighbours[triangle][size_t(side)];
        if (next == PlacedMesh::kNone || isTaken_[next] ||
            glm::dot(placed_.normals[next], normal) < kChartCosine ||
            isCrease(placed_, triangle, side, next) || taken.overlaps(chart.project(placed_, next)))
          continue;
        take(next);
      }
    }
    turn(chart);
    return chart;
  }

  // Turns the axes to the smallest rectangle of some: along the edges of the first triangle, and
  // directions 90/16 degrees apart.
  void turn(Chart& chart) const {
    std::vector<glm::dvec2> points;
    for (const uint32_t triangle : chart.triangles)
      for (const glm::dvec2& p : chart.project(placed_, triangle)) points.push_back(p);
    constexpr int kTurns = 16;
    std::vector<glm::dvec2> directions;
    for (int side = 0; side < 3; ++side) {
      const glm::dvec2 edge = points[size_t(side + 1) % 3] - points[size_t(side)];
      if (const double length = glm::length(edge); length > 0) directions.push_back(edge / length);
    }
    for (int i = 0; i < kTurns; ++i) {
      const double angle = i * kPiD / (2 * kTurns);
      directions.emplace_back(std::cos(angle), std::sin(angle));
    }
    Rectangle best = around(points, directions.front());
    for (const glm::dvec2& direction : directions) {
      const Rectangle other = around(points, direction);
      if (other.area() < 0.999 * best.area()) best = other;
    }
    if (best.size().y > best.size().x) best = around(points, {-best.along.y, best.along.x});
    const glm::dvec3 u = chart.axisU, v = chart.axisV;
    chart.axisU = best.along.x * u + best.along.y * v;
    chart.axisV = -best.along.y * u + best.along.x * v;
    chart.origin += best.min.x * chart.axisU + best.min.y * chart.axisV;
    chart.size = best.size();
  }

  struct Rectangle {
    glm::dvec2 along, min, max;

    glm::dvec2 size() const { return max - min; }
    double area() const { return size().x * size().y; }
  };
  static Rectangle around(const std::vector<glm::dvec2>& points, const glm::dvec2& along) {
    Rectangle box{along, glm::dvec2(INFINITY), glm::dvec2(-INFINITY)};
    for (const glm::dvec2& p : points) {
      const glm::dvec2 turned(glm::dot(p, along), along.x * p.y - along.y * p.x);
      box.min = glm::min(box.min, turned), box.max = glm::max(box.max, turned);
    }
    return box;
  }

  const PlacedMesh& placed_;
  std::vector<uint8_t> isTaken_;
  double cell_;
};

}  // namespace

std::vector<Chart> makeCharts(const PlacedMesh& placed) { return ChartMaker(placed).make(); }

}  // namespace chromeball
