// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/stitch.h"

#include <algorithm>

#include "probe/convert.h"
#include "probe/solid_angle.h"

namespace chromeball {

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
  double finest = kPiD;
  for (const Tile& tile : tiles) finest = std::min(finest, TileView(tile).pixelAngle());
  const int height = 2 * std::clamp(int(std::ceil(kPiD / finest / 2)), 1, 1 << 14);
  return {2 * height, height};
}

}  // namespace chromeball
