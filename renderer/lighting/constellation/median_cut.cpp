// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/median_cut.h"

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

}  // namespace

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

std::vector<Region> medianCutRegions(const RegionTable& table, int count) {
  return subdivide(
      table, count, [&](const Region& r) { return table.moment(r).w; },
      [&](const Region& r) { return cutInHalf(table, r); });
}

Constellation medianCut(const RegionTable& table, int count) {
  return table.lights(medianCutRegions(table, count));
}

Constellation medianCut(const Image& latLong, int count) {
  return medianCut(RegionTable(latLong), count);
}

Partition medianCutPartition(const Image& latLong, int count) {
  const RegionTable table(latLong);
  return table.partition(latLong, medianCutRegions(table, count));
}

}  // namespace chromeball
