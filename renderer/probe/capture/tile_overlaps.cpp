// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/tile_overlaps.h"

#include "base/parallel.h"
#include "probe/mapping.h"
#include "probe/solid_angle.h"

namespace chromeball {

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

}  // namespace chromeball
