// SPDX-License-Identifier: Apache-2.0
// `median-cut` (Debevec 2005): regions of nearly equal energy.
#pragma once

#include "lighting/constellation/region_table.h"

namespace chromeball {

// The region of most energy (luminance) is cut in two halves of energy, to within half a column's
// or row's, across its longer side, width counting times the cosine of the latitude of its middle.
// So any count will do; powers of two give the published algorithm. A region's light stands at the
// energy centroid of its directions. Regions do not reach across the seam of the map: turning the
// map by some columns does not just turn the lights.
std::vector<Region> medianCutRegions(const RegionTable& table, int count);
Constellation medianCut(const RegionTable& table, int count);

}  // namespace chromeball
