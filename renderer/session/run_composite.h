// SPDX-License-Identifier: Apache-2.0
// Renders a description with [composite].
#pragma once

#include "session/load_scene.h"
#include "session/render_loaded.h"

namespace chromeball {

// Estimates the local scene's reflectance if the description requests it, then renders the
// composite.
FinishedRender renderComposite(const LoadedScene& loaded, const PreparedScene& prepared,
                               const RenderSettings& settings, const Progress& progress,
                               const Stop& stop, RenderControl* control);

// The local scene of a composite, and the probe's scale by its plate.

// Adds the ground if the composite has one, determines the objects and the local scene, and sets
// the local scene's reflectance and gloss. Throws InputError.
void prepareLocalScene(LoadedScene& loaded);

// Scales the probe by the plate, if the description says so, after prepareLocalScene(). Throws
// InputError.
void scaleProbeByPlate(LoadedScene& loaded);

}  // namespace chromeball
