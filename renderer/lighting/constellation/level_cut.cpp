// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/level_cut.h"

#include <algorithm>
#include <numeric>

#include "lighting/constellation/median_cut.h"

namespace chromeball {
namespace {

// Indices of the regions, those of high energy first.
std::vector<int> byEnergy(const RegionTable& table, const std::vector<Region>& regions) {
  std::vector<double> energy;
  for (const Region& r : regions) energy.push_back(table.moment(r).w);
  std::vector<int> order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return energy[a] > energy[b]; });
  return order;
}

}  // namespace

std::vector<Region> levelCutRegions(const RegionTable& table, const LevelCut& cut) {
  const Region whole{0, 0, table.texels().width(), table.texels().height()};
  if (table.litCells(whole) == 0) return {};
  std::vector<Region> regions{whole};
  bool cuttable = true;
  for (int level = 0; level < cut.levels && cuttable; ++level) {
    cuttable = false;
    for (const int index : byEnergy(table, regions)) {
      if (int(regions.size()) >= cut.count) return regions;
      if (table.litCells(regions[index]) < 2) continue;
      const auto [first, second] = cutInHalf(table, regions[index]);
      cuttable = true;
      const bool firstIsLit = table.litCells(first) > 0;
      regions[index] = firstIsLit ? first : second;
      if (firstIsLit && table.litCells(second) > 0) regions.push_back(second);
    }
  }
  return regions;
}

Constellation levelCut(const Image& latLong, const LevelCut& cut) {
  const RegionTable table(latLong, cut.measure);
  return table.lights(levelCutRegions(table, cut), cut.place);
}

Partition levelCutPartition(const Image& latLong, const LevelCut& cut) {
  const RegionTable table(latLong, cut.measure);
  return table.partition(latLong, levelCutRegions(table, cut));
}

}  // namespace chromeball
