// SPDX-License-Identifier: Apache-2.0
// The constellation methods (lighting/constellation/) as rows of the table of lighting methods.
#pragma once

#include "lighting/methods.h"

namespace chromeball {

// Cut by energy if a count is given, by levels if a number of levels is given.
LightingMethod::Lights medianCutLights(CountRange counts);

// Cut by levels: lights at the regions' centres; and a cut of the map as a flat picture.
LightingMethod::Lights centreCutLights(CountRange counts);
LightingMethod::Lights flatCutLights(CountRange counts);

LightingMethod::Lights varianceCutLights(CountRange counts);
LightingMethod::Lights lightGenLights(CountRange counts);
LightingMethod::Lights kolligKellerLights(CountRange counts);
LightingMethod::Lights strataLights(CountRange counts);
LightingMethod::Lights cubeGridLights(CountRange counts);
LightingMethod::Lights penroseLights(CountRange counts);

}  // namespace chromeball
