// SPDX-License-Identifier: Apache-2.0
// The sections [composite] and [surroundings] of a scene file.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"

namespace chromeball {

// Both throw InputError.
void readComposite(const Section& section, SceneFile& scene);
SurroundingsEntry readSurroundings(const Section& section);

}  // namespace chromeball
