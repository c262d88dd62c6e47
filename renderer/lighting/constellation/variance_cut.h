// SPDX-License-Identifier: Apache-2.0
// `variance-cut` (Viriyothai and Debevec, "Variance Minimization Light Probe Sampling", SIGGRAPH
// posters 2009): regions of small variance.
#pragma once

#include "lighting/constellation/region_table.h"

namespace chromeball {

// Repeatedly cuts the region of largest variance, sum of weight |direction - centroid|^2 over its
// texels, at the column or row that minimises the total variance of the two parts. For unit
// directions the variance is weight - |moment|^2 / weight, so each candidate takes four look-ups.
// As with median-cut, no region crosses the seam of the map.
std::vector<Region> varianceCutRegions(const RegionTable& table, int count);
Constellation varianceCut(const RegionTable& table, int count);
Constellation varianceCut(const Image& latLong, int count);
Partition varianceCutPartition(const Image& latLong, int count);

}  // namespace chromeball
