// SPDX-License-Identifier: Apache-2.0
// The settings that a command takes from a scene file.
#pragma once

#include "front/scene_file.h"
#include "scene_options.h"

namespace chromeball {

// Removes the settings of the file that have no effect on the command's output, so that they have
// none by accident either, and adds a warning that names the ones that would change an image.
void dropUnheeded(SceneFile& scene, SceneCommand command);

// Removes all that says how light reaches the models, on which their occlusion does not depend, and
// adds a warning that names what `options` had of it.
void dropLight(SceneFile& scene, Settings& options);

}  // namespace chromeball
