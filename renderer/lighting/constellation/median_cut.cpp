// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/median_cut.h"

#include <functional>
#include <numeric>

namespace chromeball {
namespace {

// The line in (low, high) that divides the energy `whole` most equally; weightBelow(line) is the
// energy before the line. high - low >= 2.
template <class WeightBelow>
int halfway(int low, int high, double whole, WeightBelow weightBelow) {
  const double half = 0.5 * whole;
  int before = low + 1, after = high - 1;  // bracket the line
  while (after - before > 1) {
    const int middle = (before + after) / 2;
    (weightBelow(middle) <= half ? before : after) = middle;
  }
  return half - weightBelow(before) <= weightBelow(after) - half ? before : after;
}

bool isWide(const RegionTable& table, const Region& r) {
  if (r.x1 - r.x0 < 2 || r.y1 - r.y0 < 2) return r.x1 - r.x0 >= 2;
  const dvec2 first = table.texels().uv(r.x0, r.y0), last = table.texels().uv(r.x1, r.y1);
  const double shrinking =
      table.measure() == RegionMeasure::SolidAngle ? std::sin(kPiD * 0.5 * (first.y + last.y)) : 1;
  return 2 * (last.x - first.x) * shrinking > last.y - first.y;
}

// The two parts of a region with two or more lit cells. Sides and energies are in the table's
// measure.
std::pair<Region, Region> cutInHalf(const RegionTable& table, const Region& r) {
  const double whole = table.moment(r).w;
  if (isWide(table, r))
    return cutAtColumn(r, halfway(r.x0, r.x1, whole, [&](int x) {
                         return table.moment({r.x0, r.y0, x, r.y1}).w;
                       }));
  return cutAtRow(r, halfway(r.y0, r.y1, whole, [&](int y) {
                    return table.moment({r.x0, r.y0, r.x1, y}).w;
                  }));
}

// Indices of the regions, in order of descending energy.
std::vector<int> byEnergy(const RegionTable& table, const std::vector<Region>& regions) {
  std::vector<int> order(regions.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(),
                           [&](int i) { return table.moment(regions[i]).w; });
  return order;
}

double variance(const dvec4& moment) {
  const dvec3 m(moment);
  return moment.w > 0 ? std::fmax(moment.w - glm::dot(m, m) / moment.w, 0.0) : 0;
}

// The two parts of a region whose total variance is least.
std::pair<Region, Region> cutByVariance(const RegionTable& table, const Region& r) {
  const dvec4 whole = table.moment(r);
  std::pair<Region, Region> best;
  double minimum = std::numeric_limits<double>::infinity();
  const auto attempt = [&](const std::pair<Region, Region>& parts) {
    const dvec4 first = table.moment(parts.first);
    const double total = variance(first) + variance(whole - first);
    if (total < minimum) minimum = total, best = parts;
  };
  for (int x = r.x0 + 1; x < r.x1; ++x) attempt(cutAtColumn(r, x));
  for (int y = r.y0 + 1; y < r.y1; ++y) attempt(cutAtRow(r, y));
  return best;
}

}  // namespace

std::vector<Region> medianCutRegions(const RegionTable& table, int count) {
  return subdivide(
      table, count, [&](const Region& r) { return table.moment(r).w; },
      [&](const Region& r) { return cutInHalf(table, r); });
}

std::vector<Region> levelCutRegions(const RegionTable& table, int levels, int count) {
  const Region whole{0, 0, table.texels().width(), table.texels().height()};
  if (table.litCells(whole) == 0) return {};
  std::vector<Region> regions{whole};
  bool cuttable = true;
  for (int level = 0; level < levels && cuttable; ++level) {
    cuttable = false;
    for (const int index : byEnergy(table, regions)) {
      if (int(regions.size()) >= count) return regions;
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

std::vector<Region> varianceCutRegions(const RegionTable& table, int count) {
  return subdivide(
      table, count, [&](const Region& r) { return variance(table.moment(r)); },
      [&](const Region& r) { return cutByVariance(table, r); });
}

}  // namespace chromeball
