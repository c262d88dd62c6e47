// SPDX-License-Identifier: Apache-2.0
// Turns a scene file and given settings into the description of a render.
#pragma once

#include "description/render_description.h"
#include "front/scene_file.h"
#include "front/settings.h"

namespace chromeball {

// Given settings override the scene file's, which override the defaults. Reads the plate of a
// composite. Throws InputError for settings that contradict each other, and for an unreadable
// plate.
RenderDescription planRender(SceneFile scene, const Settings& over = {});

// The tone operator, white balance and exposure of a .png. Throws InputError.
struct PlannedDisplay {
  DisplayTransform transform;
  bool choosesExposure;  // it is "auto", and `transform` has 0
};
PlannedDisplay planDisplay(const Settings& settings);

// The composite of a description, from its settings.

// Reads the plate, whose size the image takes unless it has another. Throws InputError.
void planComposite(const Settings& settings, CompositeEntry entry, RenderDescription& description);

}  // namespace chromeball
