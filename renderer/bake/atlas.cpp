// SPDX-License-Identifier: Apache-2.0
#include "bake/atlas.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/error.h"

namespace chromeball {
namespace {

// Texels of a length with padding on both sides; more than a page for one that is too long.
int texelsOf(double metres, double density, int padding) {
  const double texels = std::ceil(metres * density - 1e-6) + 1 + 2.0 * padding;
  return int(std::min(std::max(texels, 1.0), 2.0 * kMaxPage));
}

// A density at which no chart needs more than 2 x 2 texels, nor the page more than is asked for.
double leastDensity(const std::vector<Chart>& charts) {
  double longest = 0;
  for (const Chart& chart : charts) longest = std::max({longest, chart.size.x, chart.size.y});
  return longest > 0 ? 1 / longest : 1;
}

// The places at a given density, in rows by height; nullopt if they do not fit on the page.
std::optional<Atlas> packAtlas(const std::vector<Chart>& charts, int size, int padding,
                               double density) {
  Atlas atlas{size, padding, density, std::vector<AtlasPlace>(charts.size())};
  for (size_t i = 0; i < charts.size(); ++i) {
    AtlasPlace& place = atlas.places[i];
    place.width = texelsOf(charts[i].size.x, density, padding);
    place.height = texelsOf(charts[i].size.y, density, padding);
    if (place.width > size || place.height > size) return {};
  }
  std::vector<size_t> order(charts.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::ranges::stable_sort(
      order, [&](size_t a, size_t b) { return atlas.places[a].height > atlas.places[b].height; });
  int x = 0, y = 0, row = 0;  // row: its height, the first chart's
  for (const size_t i : order) {
    AtlasPlace& place = atlas.places[i];
    if (x + place.width > size) x = 0, y += row, row = 0;
    row = std::max(row, place.height);
    if (y + row > size) return {};
    place.x = x, place.y = y;
    x += place.width;
  }
  return atlas;
}

// The smallest page that has room for all charts at the least density; nullopt if none has.
std::optional<int> leastPage(const std::vector<Chart>& charts, int padding) {
  for (int size = 4; size <= kMaxPage; size *= 2)
    if (packAtlas(charts, size, padding, leastDensity(charts))) return size;
  return {};
}

}  // namespace

Atlas fitAtlas(const std::vector<Chart>& charts, int size, int padding,
               const std::string& location) {
  double low = leastDensity(charts), high = low * size;
  std::optional<Atlas> best = packAtlas(charts, size, padding, low);
  if (!best) {
    const std::optional<int> needed = leastPage(charts, padding);
    throwInput("{}: {} x {} texels are too few for {} charts with {} texels of padding; {}",
               location, size, size, charts.size(), padding,
               needed
                   ? fmt::format("{} would do", *needed)
                   : fmt::format("so are {}; bake the model in parts, or to vertices", kMaxPage));
  }
  while (high > 1.001 * low) {
    const double middle = std::sqrt(low * high);
    std::optional<Atlas> atlas = packAtlas(charts, size, padding, middle);
    (atlas ? low : high) = middle;
    if (atlas) best = std::move(atlas);
  }
  return std::move(*best);
}

Atlas atlasOfTexels(const std::vector<Chart>& charts, double metres, int padding,
                    const std::string& location) {
  for (int size = 4; size <= kMaxPage; size *= 2)
    if (std::optional<Atlas> atlas = packAtlas(charts, size, padding, 1 / metres))
      return std::move(*atlas);
  throwInput("{}: texels of {:g} m need a page of more than {} x {}; {}", location, metres,
             kMaxPage, kMaxPage,
             leastPage(charts, padding) ? "give larger ones, or the size of the page"
                                        : "bake the model in parts, or to vertices");
}

}  // namespace chromeball
