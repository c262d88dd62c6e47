// SPDX-License-Identifier: Apache-2.0
// Where tiles see the same directions.
#pragma once

#include <span>
#include <vector>

#include "probe/capture/tile.h"

namespace chromeball {

struct Overlap {
  int first, second;  // indices of two tiles
  glm::dvec3 direction;
  float weight;  // product of both windows, times the solid angle
};

// At the texel centres of a lat-long map of this height, row by row.
std::vector<Overlap> overlapsOf(std::span<const TileView> views, int height);

}  // namespace chromeball
