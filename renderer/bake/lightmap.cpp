// SPDX-License-Identifier: Apache-2.0
#include "bake/lightmap.h"

#include <unordered_map>

#include "base/parallel.h"
#include "math/vec.h"

namespace chromeball {

Lightmap makeLightmap(const PointLight& what, const std::vector<BakePoint>& points,
                      const BakeResult& baked, const std::vector<Rgb>& light, const Atlas& atlas) {
  const int size = atlas.size;
  Lightmap map{Image(size, size, 3), Image(size, size, 4)};
  std::vector<uint8_t> isBaked(size_t(size) * size_t(size));
  forIndices(points.size(), 100, [&](size_t i) {
    if (baked.points[i].buried) return;
    const int x = int(points[i].x), y = int(points[i].y);
    isBaked[size_t(y) * size_t(size) + size_t(x)] = 1;
    map.light.setRgb(x, y, light[i]);
    const vec4 shown = shownColor(what, points[i], light[i]);
    for (int c = 0; c < 4; ++c) map.shown.at(x, y)[c] = shown[c];
  });
  for (const BakePoint& point : points)
    if (countsForScale(what.scene(), point.instance))
      map.brightest =
          std::max(map.brightest, maxComponent(map.shown.rgb(int(point.x), int(point.y))));
  fillPage(map.light, isBaked, atlas);
  fillPage(map.shown, std::move(isBaked), atlas);
  return map;
}

std::vector<BakedGeometry> lightmappedGeometry(const std::vector<PlacedMesh>& meshes,
                                               const std::vector<Chart>& charts,
                                               const Atlas& atlas) {
  std::vector<BakedGeometry> all;
  for (const PlacedMesh& placed : meshes) all.emplace_back(placed);
  for (size_t i = 0; i < charts.size(); ++i) {
    const Chart& chart = charts[i];
    const PlacedMesh& placed = meshes[size_t(chart.instance)];
    BakedGeometry& geometry = all[size_t(chart.instance)];
    std::unordered_map<uint32_t, uint32_t> ofChart;
    for (const uint32_t triangle : chart.triangles) {
      Triangle own;
      for (int corner = 0; corner < 3; ++corner) {
        const uint32_t vertex = placed.triangle(triangle)[corner];
        const auto [found, isNew] = ofChart.try_emplace(vertex, uint32_t(geometry.vertices.size()));
        own[corner] = found->second;
        if (!isNew) continue;
        geometry.vertices.push_back(vertex);
        geometry.lightmapUv.emplace_back(atlas.toPage(i, chart.project(placed.positions[vertex])) /
                                         double(atlas.size));
      }
      geometry.add(own);
    }
  }
  return all;
}

namespace {

constexpr int kReach = 5;         // of windows: 11 x 11 texels
constexpr int kPatch = 1;         // of patches: 3 x 3 texels
constexpr int kNoiseReach = 2;    // of windows in which the noise is averaged: 5 x 5 texels
constexpr float kLeast = 1e-10f;  // relative variance that differences are compared with

class TexelFilter {
 public:
  TexelFilter(const std::vector<BakePoint>& points, const BakeResult& baked, int size)
      : points_(points), baked_(baked), size_(size), index_(size_t(size) * size_t(size), -1) {
    for (size_t i = 0; i < points.size(); ++i)
      if (!baked.points[i].buried)
        index_[size_t(points[i].y) * size_t(size) + points[i].x] = int(i);
    scaled_.resize(points.size());
    const float scale = 1 / powerOfTwoNear(meanLight());
    for (size_t i = 0; i < points.size(); ++i)
      for (size_t half = 0; half < 2; ++half)
        scaled_[i][half] = scale * baked.points[i].halves[half];
    variances_.resize(points.size());
    forIndices(points.size(), 25, [&](size_t i) { variances_[i] = varianceAround(i); });
  }

  Rgb filtered(size_t i) const {
    const BakePoint& p = points_[i];
    std::array<glm::dvec3, 2> sums{};
    std::array<double, 2> weights{};
    const std::array<Rgb, 2>& own = baked_.points[i].halves;
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dx = -kReach; dx <= kReach; ++dx) {
        const int other = at(p, dx, dy);
        if (other < 0) continue;
        for (size_t half = 0; half < 2; ++half) {
          const double weight = std::exp(-std::max(difference(i, dx, dy, half), 0.0f));
          // Differences from the texel itself: 0 where the light is constant.
          sums[1 - half] +=
              weight * glm::dvec3(baked_.points[size_t(other)].halves[1 - half] - own[1 - half]);
          weights[1 - half] += weight;
        }
      }
    Rgb mean(0);
    for (size_t half = 0; half < 2; ++half)
      mean += 0.5f * glm::max(own[half] + Rgb(sums[half] / weights[half]), 0.0f);
    return mean;
  }

 private:
  // The point of the same chart at a texel relative to another; -1: none.
  int at(const BakePoint& p, int dx, int dy) const {
    const int x = int(p.x) + dx, y = int(p.y) + dy;
    if (x < 0 || y < 0 || x >= size_ || y >= size_) return -1;
    const int i = index_[size_t(y) * size_t(size_) + size_t(x)];
    return i >= 0 && points_[size_t(i)].chart == p.chart ? i : -1;
  }

  double meanLight() const {
    double sum = 0;
    for (const PointResult& point : baked_.points) sum += luminance(glm::dvec3(point.mean()));
    return sum / double(std::max<size_t>(baked_.points.size(), 1));
  }

  // The variance of a half: the mean of the squared differences of the halves, / 2.
  Rgb varianceAround(size_t i) const {
    Rgb sum(0);
    int count = 0;
    for (int dy = -kNoiseReach; dy <= kNoiseReach; ++dy)
      for (int dx = -kNoiseReach; dx <= kNoiseReach; ++dx)
        if (const int other = at(points_[i], dx, dy); other >= 0) {
          const auto& halves = scaled_[size_t(other)];
          const Rgb apart = halves[0] - halves[1];
          sum += 0.5f * apart * apart;
          ++count;
        }
    return count > 0 ? sum / float(count) : Rgb(0);
  }

  // The mean over the patches of both texels, and over channels, of
  //   ((a - b)^2 - (var a + var b)) / (var a + var b).
  float difference(size_t i, int dx, int dy, size_t half) const {
    const BakePoint& p = points_[i];
    float sum = 0;
    int count = 0;
    for (int py = -kPatch; py <= kPatch; ++py)
      for (int px = -kPatch; px <= kPatch; ++px) {
        const int first = at(p, px, py), second = at(p, px + dx, py + dy);
        if (first < 0 || second < 0) continue;
        const Rgb& a = scaled_[size_t(first)][half];
        const Rgb& b = scaled_[size_t(second)][half];
        const Rgb noise = variances_[size_t(first)] + variances_[size_t(second)];
        const Rgb terms = ((a - b) * (a - b) - noise) / (noise + kLeast * (a * a + b * b) + 1e-30f);
        sum += terms.x + terms.y + terms.z;
        count += 3;
      }
    return sum / float(std::max(count, 1));
  }

  const std::vector<BakePoint>& points_;
  const BakeResult& baked_;
  int size_;
  std::vector<int> index_;                  // by texel: its point's index, or -1
  std::vector<std::array<Rgb, 2>> scaled_;  // halves by point, near 1: their squares are floats
  std::vector<Rgb> variances_;              // by point, of one half of these
};

}  // namespace

std::vector<Rgb> filteredLight(const std::vector<BakePoint>& points, const BakeResult& baked,
                               int size) {
  const TexelFilter filter(points, baked, size);
  std::vector<Rgb> light(points.size());
  forIndices(points.size(), 1000, [&](size_t i) {
    if (!baked.points[i].buried) light[i] = filter.filtered(i);
  });
  return light;
}

namespace {

class PlaceFiller {
 public:
  PlaceFiller(Image& page, std::vector<uint8_t>& isFilled, const AtlasPlace& place)
      : page_(page), isFilled_(isFilled), place_(place) {}

  void fill() {
    std::vector<glm::ivec2> ring;
    for (int y = place_.y; y < place_.y + place_.height; ++y)
      for (int x = place_.x; x < place_.x + place_.width; ++x)
        if (!at(x, y) && touchesLight(x, y)) ring.emplace_back(x, y);
    while (!ring.empty()) {
      for (const glm::ivec2& p : ring) average(p.x, p.y);
      std::vector<glm::ivec2> next;
      for (const glm::ivec2& p : ring) at(p.x, p.y) = kFilled;
      for (const glm::ivec2& p : ring)
        forNeighbours(p.x, p.y, [&](int x, int y) {
          if (at(x, y) != kEmpty) return;
          at(x, y) = kWaiting;
          next.emplace_back(x, y);
        });
      for (const glm::ivec2& p : next) at(p.x, p.y) = kEmpty;
      ring = std::move(next);
    }
    for (int y = place_.y; y < place_.y + place_.height; ++y)
      for (int x = place_.x; x < place_.x + place_.width; ++x) at(x, y) = kFilled;
  }

 private:
  enum : uint8_t { kEmpty = 0, kFilled = 1, kWaiting = 2 };

  uint8_t& at(int x, int y) { return isFilled_[size_t(y) * size_t(page_.width) + size_t(x)]; }

  template <class Visit>
  void forNeighbours(int x, int y, const Visit& visit) {
    for (int ny = std::max(y - 1, place_.y); ny <= std::min(y + 1, place_.y + place_.height - 1);
         ++ny)
      for (int nx = std::max(x - 1, place_.x); nx <= std::min(x + 1, place_.x + place_.width - 1);
           ++nx)
        if (nx != x || ny != y) visit(nx, ny);
  }

  bool touchesLight(int x, int y) {
    bool touches = false;
    forNeighbours(x, y, [&](int nx, int ny) { touches |= at(nx, ny) == kFilled; });
    return touches;
  }

  // Texels of the same ring are not filled yet, so their order does not matter.
  void average(int x, int y) {
    for (int channel = 0; channel < page_.channels; ++channel) {
      float sum = 0;
      int count = 0;
      forNeighbours(x, y, [&](int nx, int ny) {
        if (at(nx, ny) != kFilled) return;
        sum += page_.at(nx, ny)[channel];
        ++count;
      });
      page_.at(x, y)[channel] = sum / float(count);
    }
  }

  Image& page_;
  std::vector<uint8_t>& isFilled_;
  const AtlasPlace& place_;
};

}  // namespace

void fillPage(Image& page, std::vector<uint8_t> isBaked, const Atlas& atlas) {
  std::vector<double> sums(size_t(page.channels));
  double count = 0;
  for (size_t i = 0; i < isBaked.size(); ++i) {
    if (!isBaked[i]) continue;
    for (size_t c = 0; c < sums.size(); ++c) sums[c] += page.texels[i * sums.size() + c];
    ++count;
  }
  parallelFor(size_t(0), atlas.places.size(),
              [&](size_t i) { PlaceFiller(page, isBaked, atlas.places[i]).fill(); });
  for (size_t i = 0; i < isBaked.size() && count > 0; ++i)
    for (size_t c = 0; c < sums.size() && !isBaked[i]; ++c)
      page.texels[i * sums.size() + c] = float(sums[c] / count);
}

}  // namespace chromeball
