// SPDX-License-Identifier: Apache-2.0
// `lightgen` (Cohen and Debevec, HDRShop plug-in, 2001; HDRI book, section 9.6.2): K-means on the
// sphere from random starts.
#pragma once

#include <cstdint>

#include "lighting/constellation/directional_light.h"
#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Lights start at `count` different cells, drawn with probability proportional to luminance, and
// move by Lloyd's iteration to convergence. The result is the one with the smallest objective
// (spherical_kmeans.h) out of four starts.
Constellation lightGen(const TexelTable& table, int count, uint64_t seed);
Constellation lightGen(const Image& latLong, int count, uint64_t seed);

// The regions of those lights. Black cells belong to the nearest light; a black map has no region.
Partition lightGenRegions(const Image& latLong, int count, uint64_t seed);

}  // namespace chromeball
