// SPDX-License-Identifier: Apache-2.0
// The regions of a map that lights replace.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace chromeball {

inline constexpr uint16_t kNoRegion = 65535;

// For each texel of a lat-long map, row by row, the index of its region: 0 to regions - 1, or
// kNoRegion for a black texel that no light stands for.
struct Partition {
  int regions = 0;
  std::vector<uint16_t> label;
};

// A straight line in the map, between two positions (u, v).
struct MapLine {
  glm::dvec2 from, to;
};

}  // namespace chromeball
