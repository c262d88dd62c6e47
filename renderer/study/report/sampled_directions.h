// SPDX-License-Identifier: Apache-2.0
// Where in the probe a strategy looks for light.
#pragma once

#include <vector>

#include "lighting/strategy.h"

namespace chromeball {

// Directions, in the world, that a strategy samples for a floor's point: all lights of a
// constellation, some random ones of any other. Empty for a strategy that samples none.
std::vector<vec3> sampledDirections(const LightingStrategy& strategy);

}  // namespace chromeball
