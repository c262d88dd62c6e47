// SPDX-License-Identifier: Apache-2.0
// The directions that a strategy samples, for display.
#pragma once

#include <vector>

#include "lighting/strategy.h"

namespace chromeball {

// World-space directions of the light samples at a point on a floor: all lights of a constellation,
// 128 random samples of other strategies. Empty for a strategy without light samples.
std::vector<vec3> sampledDirections(const LightSource& strategy);

}  // namespace chromeball
