// SPDX-License-Identifier: Apache-2.0
// `median-cut` (Debevec, "A Median Cut Algorithm for Light Probe Sampling", SIGGRAPH posters 2005):
// regions of nearly equal energy.
#pragma once

#include "lighting/constellation/region_table.h"

namespace chromeball {

// Repeatedly cuts the region of highest energy (luminance) across its longer side, at the column or
// row that divides the energy most equally; the width counts times the cosine of the latitude. Any
// count is possible; powers of two give the published algorithm (level_cut.h has it to the letter).
// A region's light is at the energy centroid of its directions. No region crosses the seam of the
// map, so the lights depend on the position of the seam.
std::vector<Region> medianCutRegions(const RegionTable& table, int count);
Constellation medianCut(const RegionTable& table, int count);
Constellation medianCut(const Image& latLong, int count);
Partition medianCutPartition(const Image& latLong, int count);

// The two parts of a region with two or more lit cells. Sides and energies are in the table's
// measure.
std::pair<Region, Region> cutInHalf(const RegionTable& table, const Region& r);

}  // namespace chromeball
