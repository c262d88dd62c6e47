// SPDX-License-Identifier: Apache-2.0
#include "bake/bake_points.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

// Raises all three weights to at least `least`.
vec2 offTheEdges(const vec2& barycentric, float least) {
  const vec3 weights =
      glm::max(vec3(1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y), least);
  return vec2(weights.y, weights.z) / (weights.x + weights.y + weights.z);
}

struct Nearest {
  double distance2 = INFINITY;  // texels^2
  uint32_t triangle = 0;
  vec2 barycentric{0};
};

// A texel that a triangle touches has its centre no farther away than half its diagonal.
constexpr double kReach2 = 0.5 + 1e-9;  // texels^2

class ChartTexels {
 public:
  ChartTexels(const PlacedMesh& placed, const Chart& chart, const Atlas& atlas, size_t index)
      : place_(atlas.places[index]),
        width_(place_.width),
        nearest_(size_t(place_.width) * size_t(place_.height)) {
    for (const uint32_t triangle : chart.triangles) {
      FlatTriangle flat = chart.project(placed, triangle);
      for (glm::dvec2& corner : flat) corner = atlas.toPage(index, corner);
      add(flat, triangle);
    }
  }

  template <class Visit>  // visit(x, y, nearest), in the texels of the page
  void forCovered(const Visit& visit) const {
    for (int y = 0; y < place_.height; ++y)
      for (int x = 0; x < width_; ++x)
        if (const Nearest& n = nearest_[size_t(y) * size_t(width_) + size_t(x)];
            n.distance2 <= kReach2)
          visit(place_.x + x, place_.y + y, n);
  }

 private:
  void add(const FlatTriangle& flat, uint32_t triangle) {
    const glm::dvec2 low = glm::min(flat[0], glm::min(flat[1], flat[2])) - 1.0;
    const glm::dvec2 high = glm::max(flat[0], glm::max(flat[1], flat[2])) + 1.0;
    const int x0 = std::max(int(std::floor(low.x)), place_.x);
    const int y0 = std::max(int(std::floor(low.y)), place_.y);
    const int x1 = std::min(int(std::ceil(high.x)), place_.x + width_);
    const int y1 = std::min(int(std::ceil(high.y)), place_.y + place_.height);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        Nearest& nearest = nearest_[size_t(y - place_.y) * size_t(width_) + size_t(x - place_.x)];
        const NearestPoint found = nearestPoint(flat, {x + 0.5, y + 0.5});
        if (found.distance2 < nearest.distance2)
          nearest = {found.distance2, triangle, found.barycentric};
      }
  }

  AtlasPlace place_;
  int width_;
  std::vector<Nearest> nearest_;
};

}  // namespace

std::vector<BakePoint> texelPoints(const std::vector<PlacedMesh>& meshes,
                                   const std::vector<Chart>& charts, const Atlas& atlas) {
  constexpr float kOffEdge = 1e-3f;
  std::vector<std::vector<BakePoint>> byChart(charts.size());
  parallelFor(size_t(0), charts.size(), [&](size_t i) {
    const Chart& chart = charts[i];
    const ChartTexels texels(meshes[size_t(chart.instance)], chart, atlas, i);
    texels.forCovered([&](int x, int y, const Nearest& nearest) {
      byChart[i].push_back({uint32_t(x), uint32_t(y), int(i), chart.instance, nearest.triangle,
                            offTheEdges(nearest.barycentric, kOffEdge), float(1 / atlas.density)});
    });
  });
  std::vector<BakePoint> points;
  for (const auto& part : byChart) points.insert(points.end(), part.begin(), part.end());
  return points;
}

std::vector<BakePoint> vertexPoints(const std::vector<PlacedMesh>& meshes) {
  constexpr float kOffVertex = 0.01f;
  std::vector<BakePoint> points;
  for (const PlacedMesh& placed : meshes) {
    std::vector<uint32_t> largest(placed.positions.size(), PlacedMesh::kNone);
    for (uint32_t i = 0; i < placed.triangleCount(); ++i)
      for (int corner = 0; corner < 3 && placed.hasArea(i); ++corner) {
        uint32_t& triangle = largest[placed.triangle(i)[corner]];
        if (triangle == PlacedMesh::kNone || placed.areas[i] > placed.areas[triangle]) triangle = i;
      }
    for (uint32_t vertex = 0; vertex < largest.size(); ++vertex) {
      const uint32_t triangle = largest[vertex];
      if (triangle == PlacedMesh::kNone) continue;
      const Triangle& t = placed.triangle(triangle);
      const vec2 corner = vertex == t.x ? vec2(0) : vertex == t.y ? vec2(1, 0) : vec2(0, 1);
      points.push_back({vertex, uint32_t(placed.instance), placed.instance, placed.instance,
                        triangle, offTheEdges(corner, kOffVertex),
                        0.01f * float(std::sqrt(placed.areas[triangle]))});
    }
  }
  return points;
}

}  // namespace chromeball
