// SPDX-License-Identifier: Apache-2.0
// `kollig-keller` (Kollig and Keller, "Efficient Illumination by High Dynamic Range Images", EGSR
// 2003): K-means on the sphere that adds one light at a time.
#pragma once

#include <cstdint>

#include "lighting/constellation/spherical_kmeans.h"

namespace chromeball {

// The first light is at the brightest cell. Each further light is added in the region with the
// largest error, sum of weight (1 - cos to its light), at the cell with the largest error; then all
// lights move by Lloyd's iteration until a step gains less than a thousandth, after the last light
// to convergence. Deterministic. From about 32 lights on the error is less than lightgen's; with
// fewer, lightgen's four random starts are sometimes better by a few percent.
SphericalKMeans kolligKellerClusters(const TexelTable& table, int count);

// The regions of its lights in a coarse table of the map.
Partition kolligKellerRegions(const Image& latLong, int count);

// `kollig-keller-strata` (the same paper, against aliasing): each light has a random direction in
// its region, with probability proportional to luminance and uniform within a texel, and the
// irradiance of the region.
Constellation kolligKellerStrata(const Image& latLong, int count, uint64_t seed);

// `lightgen` (Cohen and Debevec, HDRShop plug-in, 2001; HDRI book, section 9.6.2): K-means on the
// sphere from random starts. Lights start at `count` different cells, drawn with probability
// proportional to luminance, and move by Lloyd's iteration to convergence. The result is the one
// with the smallest objective (spherical_kmeans.h) out of four starts.
SphericalKMeans lightGenClusters(const TexelTable& table, int count, uint64_t seed);

}  // namespace chromeball
