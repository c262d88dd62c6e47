// SPDX-License-Identifier: Apache-2.0
// Small probes that are difficult for samplers of directions.
#pragma once

#include <vector>

#include "image/image.h"

namespace chromeball {

// One bright texel on a background, or on black.
Image spot(int width, int height, int x, int y, float radiance, float rest);

struct HardProbe {
  const char* name;
  Image image;
};

std::vector<HardProbe> hardProbes();

}  // namespace chromeball
