// SPDX-License-Identifier: Apache-2.0
// The sections [composite] and [surroundings] of a scene file.
#pragma once

#include "job/toml_section.h"

namespace chromeball {

// `root` is the whole file, which has the section. Both throw InputError.
CompositeEntry readComposite(const Section& root);
Surroundings readSurroundings(const Section& root);

}  // namespace chromeball
