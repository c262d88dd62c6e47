// SPDX-License-Identifier: Apache-2.0
// `median-cut` (Debevec, "A Median Cut Algorithm for Light Probe Sampling", SIGGRAPH posters 2005):
// regions of nearly equal energy.
#pragma once

#include <limits>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Repeatedly cuts the region of highest energy (luminance) across its longer side, at the column or
// row that divides the energy most equally; the width counts times the cosine of the latitude. Any
// count is possible; powers of two give the published algorithm (below, to the letter). A region's
// light is at the energy centroid of its directions. No region crosses the seam of the map, so the
// lights depend on the position of the seam.
std::vector<Region> medianCutRegions(const RegionTable& table, int count);

// `median-cut-centre`, `median-cut-flat`, and median cut by levels: the variants that the HDRI book
// (section 9.6.2) and Madsen and Laursen (2007, section 4.1) describe.
// All regions are cut before any of their parts: after K levels there are 2^K, but
// at most `count`: on the last level those with the highest energy are cut. Black margins stay in
// their regions, which matters for centres. A part without light is dropped; a region of a single
// lit cell is not cut.
std::vector<Region> levelCutRegions(const RegionTable& table, int levels, int count);

// `variance-cut` (Viriyothai and Debevec, "Variance Minimization Light Probe Sampling", SIGGRAPH
// posters 2009): regions of small variance.

// Repeatedly cuts the region of largest variance, sum of weight |direction - centroid|^2 over its
// texels, at the column or row that minimises the total variance of the two parts. For unit
// directions the variance is weight - |moment|^2 / weight, so each candidate takes four look-ups.
// As with median-cut, no region crosses the seam of the map.
std::vector<Region> varianceCutRegions(const RegionTable& table, int count);

}  // namespace chromeball
