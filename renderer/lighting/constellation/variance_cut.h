// SPDX-License-Identifier: Apache-2.0
// `variance-cut` (Viriyothai and Debevec 2009): regions of small variance.
#pragma once

#include "lighting/constellation/region_table.h"

namespace chromeball {

// The region of greatest variance, sum of weight |direction - centroid|^2 over its texels, is cut
// along the column or row that leaves the least variance in its two parts together. For unit
// directions the variance is weight - |moment|^2 / weight, so each trial costs four look-ups.
// As with median-cut, regions do not reach across the seam of the map.
std::vector<Region> varianceCutRegions(const RegionTable& table, int count);
Constellation varianceCut(const RegionTable& table, int count);

}  // namespace chromeball
