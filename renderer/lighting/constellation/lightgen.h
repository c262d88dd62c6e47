// SPDX-License-Identifier: Apache-2.0
// `lightgen` (Cohen and Debevec 2001; HDRI book, 9.6.2): K-means from random starts.
#pragma once

#include <cstdint>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Lights start at `count` different cells drawn by luminance and move by Lloyd's iteration to
// convergence; of four starts the one with the least objective (spherical_kmeans.h) is taken.
// `table`: of kCoarseCells.
Constellation lightGen(const TexelTable& table, int count, uint64_t seed);

}  // namespace chromeball
