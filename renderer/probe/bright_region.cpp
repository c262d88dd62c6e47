// SPDX-License-Identifier: Apache-2.0
#include "probe/bright_region.h"

namespace chromeball {

std::vector<Texel> gatherRegion(const Image& latLong, Texel start, double threshold,
                                std::vector<bool>& visited) {
  std::vector<Texel> region;
  const auto visit = [&](int x, int y) {
    x = (x + latLong.width) % latLong.width;
    const size_t index = size_t(y) * latLong.width + x;
    if (visited[index] || luminance(latLong.rgb(x, y)) <= threshold) return;
    visited[index] = true;
    region.push_back({x, y});
  };
  visit(start.x, start.y);
  for (size_t i = 0; i < region.size(); ++i) {
    const Texel t = region[i];
    for (int y = t.y - 1; y <= t.y + 1; ++y)
      if (y >= 0 && y < latLong.height)
        for (int dx = -1; dx <= 1; ++dx) visit(t.x + dx, y);
  }
  return region;
}

}  // namespace chromeball
