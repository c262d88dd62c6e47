// SPDX-License-Identifier: Apache-2.0
// What a pixel reflects of light from each direction, as a picture over the directions (HDRI book,
// section 9.9.2, Figure 9.45).
#pragma once

#include "relight/light_stage.h"

namespace chromeball {

// A lat-long map of radiance per irradiance on a surface that faces the light, 1/sr: f cos x
// visibility, and interreflection. Of boxes one texel for each; of other bases 64 x 32 texels, of
// which each shows the cell of its centre, or the sum of the harmonics.
Image reflectanceFunction(const LightStage& stage, int x, int y);

}  // namespace chromeball
