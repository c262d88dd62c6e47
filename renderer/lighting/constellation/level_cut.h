// SPDX-License-Identifier: Apache-2.0
// `median-cut-centre`, `median-cut-flat`, and median cut by levels: the variants that the HDRI book
// (section 9.6.2) and Madsen and Laursen (2007, section 4.1) describe.
#pragma once

#include <limits>

#include "lighting/constellation/region_table.h"

namespace chromeball {

// All regions are cut (median_cut.h) before any of their parts: after K levels there are 2^K. Black
// margins stay in their regions, which matters for centres.
struct LevelCut {
  RegionMeasure measure = RegionMeasure::SolidAngle;
  LightPlace place = LightPlace::Centroid;
  int levels = std::numeric_limits<int>::max();  // maximum
  int count = 64;                                // of regions, maximum; those of the last level
                                                 // with the highest energy are cut
};

// A part without light is dropped; a region of a single lit cell is not cut.
std::vector<Region> levelCutRegions(const RegionTable& table, const LevelCut& cut);
Constellation levelCut(const Image& latLong, const LevelCut& cut);
Partition levelCutPartition(const Image& latLong, const LevelCut& cut);

}  // namespace chromeball
