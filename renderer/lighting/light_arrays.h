// SPDX-License-Identifier: Apache-2.0
// Light samples, or the light that rays find, in arrays (math/lanes.h).
#pragma once

#include "math/lanes.h"

namespace chromeball {

struct LightArrays {
  LaneArrays3 direction;             // of samples: unit, towards the light
  LaneArrays3 light;                 // irradiance of a sample (DirectionSample), or radiance
  alignas(64) LaneArray<float> pdf;  // over solid angle; of a sample that does not exist: 0
};

}  // namespace chromeball
