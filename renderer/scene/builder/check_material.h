// SPDX-License-Identifier: Apache-2.0
// The ranges of a material's numbers (glTF 2.0 and its extensions).
#pragma once

#include <cstddef>

#include "scene/material.h"

namespace chromeball {

// Throws InputError that names the material and the number or texture slot that is wrong.
// `textures`: how many there are.
void checkMaterial(const Material& material, size_t textures);

}  // namespace chromeball
