// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/region_table.h"

#include <queue>

namespace chromeball {
namespace {

// Smallest x in [low, high] for which the predicate holds, by bisection. Above it the predicate
// holds everywhere; it holds at `high`.
template <class Predicate>
int firstWhere(int low, int high, Predicate holds) {
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (holds(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

}  // namespace

RegionTable::RegionTable(const Image& latLong)
    : texels_(latLong, kFineCells),
      moments_(size_t(texels_.width() + 1) * (texels_.height() + 1), dvec4(0)),
      lit_(moments_.size()) {
  for (int y = 0; y < texels_.height(); ++y) {
    dvec4 rowMoment(0);
    int32_t rowLit = 0;
    for (int x = 0; x < texels_.width(); ++x) {
      const TexelSum& cell = texels_.at(x, y);
      rowMoment += dvec4(cell.moment, cell.weight);
      rowLit += cell.weight > 0;
      moments_[corner(x + 1, y + 1)] = moments_[corner(x + 1, y)] + rowMoment;
      lit_[corner(x + 1, y + 1)] = lit_[corner(x + 1, y)] + rowLit;
    }
  }
}

dvec4 RegionTable::moment(const Region& r) const {
  return (moments_[corner(r.x1, r.y1)] - moments_[corner(r.x0, r.y1)]) -
         (moments_[corner(r.x1, r.y0)] - moments_[corner(r.x0, r.y0)]);
}

int RegionTable::litCells(const Region& r) const {
  return lit_[corner(r.x1, r.y1)] - lit_[corner(r.x0, r.y1)] - lit_[corner(r.x1, r.y0)] +
         lit_[corner(r.x0, r.y0)];
}

Region RegionTable::trimmed(const Region& r) const {
  const int all = litCells(r);
  Region t = r;
  t.x1 = firstWhere(r.x0, r.x1, [&](int x) { return litCells({r.x0, r.y0, x, r.y1}) == all; });
  t.y1 = firstWhere(r.y0, r.y1, [&](int y) { return litCells({r.x0, r.y0, r.x1, y}) == all; });
  t.x0 = firstWhere(r.x0, r.x1, [&](int x) { return litCells({x, r.y0, r.x1, r.y1}) < all; }) - 1;
  t.y0 = firstWhere(r.y0, r.y1, [&](int y) { return litCells({r.x0, y, r.x1, r.y1}) < all; }) - 1;
  return t;
}

Constellation RegionTable::lights(const std::vector<Region>& regions) const {
  Constellation lights;
  lights.reserve(regions.size());
  for (const Region& r : regions) {
    TexelSum sum;
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x) sum += texels_.at(x, y);
    lights.push_back(lightAt(sum, texels_.direction(0.5 * (r.x0 + r.x1), 0.5 * (r.y0 + r.y1))));
  }
  return lights;
}

std::pair<Region, Region> cutAtColumn(const Region& r, int x) {
  return {{r.x0, r.y0, x, r.y1}, {x, r.y0, r.x1, r.y1}};
}

std::pair<Region, Region> cutAtRow(const Region& r, int y) {
  return {{r.x0, r.y0, r.x1, y}, {r.x0, y, r.x1, r.y1}};
}

std::vector<Region> subdivide(const RegionTable& table, int count,
                              const std::function<double(const Region&)>& priority,
                              const std::function<std::pair<Region, Region>(const Region&)>& cut) {
  std::vector<Region> regions;
  std::priority_queue<std::pair<double, int>> cuttable;  // priority, index in `regions`
  const auto put = [&](int index, const Region& r) {
    regions[index] = table.trimmed(r);
    if (table.litCells(r) > 1) cuttable.push({priority(regions[index]), index});
  };
  const Region whole{0, 0, table.texels().width(), table.texels().height()};
  if (table.litCells(whole) == 0) return {};
  regions.resize(1);
  put(0, whole);
  while (int(regions.size()) < count && !cuttable.empty()) {
    const int index = cuttable.top().second;
    cuttable.pop();
    const auto [first, second] = cut(regions[index]);
    regions.emplace_back();
    put(index, first);
    put(int(regions.size()) - 1, second);
  }
  return regions;
}

}  // namespace chromeball
