// SPDX-License-Identifier: Apache-2.0
// `kollig-keller` (Kollig and Keller 2003): K-means that grows by one light at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/texel_table.h"

namespace chromeball {

// The first light stands at the brightest cell. Each further one is added in the region of most
// error, sum of weight (1 - cos to its light), at the cell that has most of it, and all move by
// Lloyd's iteration until that gains less than a thousandth; after the last to convergence. Nothing
// is random. From about 32 lights on the error is less than lightgen's; of fewer, four random
// starts sometimes find a better place by a few percent. `table`: of kCoarseCells.
Constellation kolligKeller(const TexelTable& table, int count);

// The regions of those lights: for each texel of the map, row by row, the number of its region,
// from 0 to regions - 1. Black cells belong to the nearest light; a black map has no region.
struct Partition {
  int regions = 0;
  std::vector<uint16_t> label;
};
Partition kolligKellerRegions(const Image& latLong, int count);

// `kollig-keller-strata`: each light's direction is drawn from its region in proportion to
// luminance, uniformly inside a texel; its irradiance is the region's.
Constellation kolligKellerStrata(const Image& latLong, int count, uint64_t seed);

}  // namespace chromeball
