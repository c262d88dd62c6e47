// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/variance_cut.h"

#include <limits>

namespace chromeball {
namespace {

double variance(const dvec4& moment) {
  const dvec3 m(moment);
  return moment.w > 0 ? std::fmax(moment.w - glm::dot(m, m) / moment.w, 0.0) : 0;
}

std::pair<Region, Region> cut(const RegionTable& table, const Region& r) {
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

std::vector<Region> varianceCutRegions(const RegionTable& table, int count) {
  return subdivide(
      table, count, [&](const Region& r) { return variance(table.moment(r)); },
      [&](const Region& r) { return cut(table, r); });
}

Constellation varianceCut(const RegionTable& table, int count) {
  return table.lights(varianceCutRegions(table, count));
}

Constellation varianceCut(const Image& latLong, int count) {
  return varianceCut(RegionTable(latLong), count);
}

Partition varianceCutPartition(const Image& latLong, int count) {
  const RegionTable table(latLong);
  return table.partition(latLong, varianceCutRegions(table, count));
}

}  // namespace chromeball
