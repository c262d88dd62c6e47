// SPDX-License-Identifier: Apache-2.0
// Given settings over those of a scene file.
#pragma once

#include "front/scene_file.h"

namespace chromeball {

// `over` replaces settings of the file, among them those that it stores with models, camera and
// composite. Throws InputError for settings that exclude each other.
void overrideSettings(SceneFile& file, const Settings& over);

}  // namespace chromeball
