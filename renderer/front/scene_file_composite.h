// SPDX-License-Identifier: Apache-2.0
// The sections [composite] and [surroundings] of a scene file.
#pragma once

#include "front/scene_file.h"
#include "front/toml_section.h"

namespace chromeball {

// Scalar keys go to `settings`. Both throw InputError.
CompositeEntry readComposite(const Section& section, Settings& settings);
SurroundingsEntry readSurroundings(const Section& section);

}  // namespace chromeball
