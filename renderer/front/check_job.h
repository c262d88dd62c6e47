// SPDX-License-Identifier: Apache-2.0
// Settings that contradict each other.
#pragma once

#include <string_view>

#include "front/scene_file.h"

namespace chromeball {

// Throws InputError, begun by the location of one of the settings. `file`: with the given settings.
void checkJob(const SceneFile& file);

}  // namespace chromeball
