// SPDX-License-Identifier: Apache-2.0
// Connected bright texels of a lat-long map.
#pragma once

#include <vector>

#include "image/image.h"

namespace chromeball {

struct Texel {
  int x, y;
};

// The texels with a luminance above `threshold` and not yet `visited` that are connected to `start`
// by eight neighbours, across the seam too. A source that covers a pole fills the row there, which
// connects it. Marks them as visited.
std::vector<Texel> gatherRegion(const Image& latLong, Texel start, double threshold,
                                std::vector<bool>& visited);

}  // namespace chromeball
