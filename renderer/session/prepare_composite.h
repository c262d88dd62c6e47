// SPDX-License-Identifier: Apache-2.0
// The local scene of a composite, and the probe's scale by its plate.
#pragma once

#include "session/load_scene.h"

namespace chromeball {

// Adds the ground if the composite has one, determines the objects and the local scene, and sets
// the local scene's reflectance and gloss. Throws InputError.
void prepareLocalScene(LoadedScene& loaded);

// Scales the probe as the plate tells, if it is to be, after prepareLocalScene(). Throws
// InputError.
void scaleProbeByPlate(LoadedScene& loaded);

}  // namespace chromeball
