// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/stitch.h"

#include <map>

#include "base/error.h"
#include "base/parallel.h"
#include "math/dense_solvers.h"
#include "probe/convert.h"

namespace chromeball {

TileView::TileView(const Tile& tile)
    : image_(tile.image),
      pose_(tile.pose.quaternion()),
      halfWidth_(std::tan(glm::radians(tile.fov) / 2) * tile.image.width / tile.image.height),
      halfHeight_(std::tan(glm::radians(tile.fov) / 2)) {}

TileView::Seen TileView::at(const glm::dvec3& direction, const glm::dquat& pose) const {
  const glm::dvec3 d = glm::conjugate(pose) * direction;
  if (!(d.z < 0)) return {};
  const double right = d.x / -d.z / halfWidth_, up = d.y / -d.z / halfHeight_;
  if (!(std::fabs(right) < 1 && std::fabs(up) < 1)) return {};
  const double x = std::clamp((1 + right) / 2 * image_.width - 0.5, 0.0, image_.width - 1.0);
  const double y = std::clamp((1 - up) / 2 * image_.height - 0.5, 0.0, image_.height - 1.0);
  const int x0 = int(x), y0 = int(y);
  const int x1 = std::min(x0 + 1, image_.width - 1), y1 = std::min(y0 + 1, image_.height - 1);
  const float s = float(x - x0), t = float(y - y0);
  Seen seen;
  seen.radiance = (1 - t) * ((1 - s) * image_.rgb(x0, y0) + s * image_.rgb(x1, y0)) +
                  t * ((1 - s) * image_.rgb(x0, y1) + s * image_.rgb(x1, y1));
  seen.weight = float(std::cos(0.5 * kPiD * right) * std::cos(0.5 * kPiD * up));
  return seen;
}

double TileView::pixelAngle() const { return 2 * halfHeight_ / image_.height; }

std::vector<Overlap> overlapsOf(std::span<const TileView> views, int height) {
  const ImageSize size{2 * height, height};
  std::vector<std::vector<Overlap>> rows(static_cast<size_t>(height));
  forRows(size.width, height, views.size(), [&](int y) {
    std::vector<std::pair<int, float>> seen;
    const double solidAngle = texelSolidAngle(y, size.width, height);
    for (int x = 0; x < size.width; ++x) {
      const dvec3 d = texelDirection(size, x, y);
      seen.clear();
      for (size_t i = 0; i < views.size(); ++i)
        if (const float weight = views[i].at(d).weight; weight > 0)
          seen.emplace_back(int(i), weight);
      for (size_t i = 0; i < seen.size(); ++i)
        for (size_t j = i + 1; j < seen.size(); ++j)
          rows[size_t(y)].push_back({seen[i].first, seen[j].first, d,
                                     float(solidAngle) * seen[i].second * seen[j].second});
    }
  });
  std::vector<Overlap> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

StitchedProbe stitch(const std::vector<Tile>& tiles, const std::vector<double>& gains,
                     const ImageSize& size) {
  constexpr int kSamples = 2;  // along the side of a texel
  const std::vector<TileView> views(tiles.begin(), tiles.end());
  const auto sumsAt = [&](const dvec3& d) {
    dvec3 sum(0);
    double weight = 0;
    for (size_t i = 0; i < views.size(); ++i) {
      const TileView::Seen seen = views[i].at(d);
      sum += double(seen.weight) * gains[i] * dvec3(seen.radiance);
      weight += double(seen.weight);
    }
    return std::pair(sum, weight);
  };
  StitchedProbe probe;
  probe.latLong = rasterize(Mapping::LatLong, size, kSamples, [&](const dvec3& d) {
    const auto [sum, weight] = sumsAt(d);
    return weight > 0 ? sum / weight : dvec3(0);
  });
  const Image seen = rasterize(Mapping::LatLong, size, kSamples,
                               [&](const dvec3& d) { return dvec3(sumsAt(d).second > 0); });
  probe.uncovered = 1 - meanRadiance(seen).x;
  return probe;
}

ImageSize stitchedSize(const std::vector<Tile>& tiles) {
  constexpr double kMostRows = 8192;
  double finest = kPiD;
  for (const Tile& tile : tiles) finest = std::min(finest, TileView(tile).pixelAngle());
  const int height = 2 * int(std::clamp(std::ceil(kPiD / finest / 2), 1.0, kMostRows / 2));
  return {2 * height, height};
}

namespace {

constexpr int kHeight = 128;  // of the map of directions

struct Ratio {
  double logarithm;  // of the second tile's luminance over the first's
  double weight;
};
using Pair = std::pair<int, int>;

// Of all pairs that overlap; none where one of the two is black.
std::map<Pair, std::vector<Ratio>> ratiosOf(const std::vector<TileView>& views) {
  std::map<Pair, std::vector<Ratio>> ratios;
  for (const Overlap& o : overlapsOf(views, kHeight)) {
    const double first = double(luminance(views[size_t(o.first)].at(o.direction).radiance));
    const double second = double(luminance(views[size_t(o.second)].at(o.direction).radiance));
    std::vector<Ratio>& ofPair = ratios[{o.first, o.second}];
    if (first > 0 && second > 0) ofPair.push_back({std::log(second / first), double(o.weight)});
  }
  return ratios;
}

// The weighted median, and all the weight.
Ratio medianOf(std::vector<Ratio> ratios) {
  std::ranges::sort(ratios, {}, &Ratio::logarithm);
  double all = 0, below = 0;
  for (const Ratio& ratio : ratios) all += ratio.weight;
  for (const Ratio& ratio : ratios)
    if ((below += ratio.weight) >= all / 2) return {ratio.logarithm, all};
  return {0, 0};
}

void checkConnected(const std::vector<Tile>& tiles,
                    const std::map<Pair, std::vector<Ratio>>& ratios) {
  std::vector<bool> reached(tiles.size());
  reached[0] = true;
  for (size_t round = 0; round < tiles.size(); ++round)
    for (const auto& [pair, all] : ratios)
      if (!all.empty() && (reached[size_t(pair.first)] || reached[size_t(pair.second)]))
        reached[size_t(pair.first)] = reached[size_t(pair.second)] = true;
  for (const auto& [pair, ignored] : ratios) {
    auto [other, seen] = pair;
    if (reached[size_t(other)]) std::swap(other, seen);
    if (!reached[size_t(other)] && reached[size_t(seen)])
      throwInput("{}: cannot be compared with {}: where they overlap, one or both are black",
                 tiles[size_t(other)].name, tiles[size_t(seen)].name);
  }
  for (size_t i = 0; i < tiles.size(); ++i)
    if (!reached[i])
      throwInput("{}: is not connected to {} by tiles that overlap", tiles[i].name, tiles[0].name);
}

}  // namespace

std::vector<double> tileGains(const std::vector<Tile>& tiles) {
  const std::vector<TileView> views(tiles.begin(), tiles.end());
  const auto ratios = ratiosOf(views);
  checkConnected(tiles, ratios);
  LeastSquares equations(int(tiles.size()));
  std::vector<LeastSquares::Term> sum;
  for (int i = 0; i < int(tiles.size()); ++i) sum.push_back({i, 1});
  equations.add(sum, 0);
  for (const auto& [pair, all] : ratios) {
    if (all.empty()) continue;
    const Ratio median = medianOf(all);
    const LeastSquares::Term row[] = {{pair.first, 1}, {pair.second, -1}};
    equations.add(row, median.logarithm, median.weight);
  }
  const auto solution = equations.solve();
  if (!solution) throwInput("{}: the overlaps of the tiles are too small", tiles[0].name);
  std::vector<double> gains;
  for (const double logarithm : *solution) gains.push_back(std::exp(logarithm));
  return gains;
}

}  // namespace chromeball
