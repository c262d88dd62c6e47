// SPDX-License-Identifier: Apache-2.0
// A glTF file's animation, evaluated at one time.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Sets translation, rotation, scale and morph weights of the animated nodes to their state at the
// given time (glTF 2.0, 3.11 and appendix C); constant before the first key and after the last.
// Marks them as `animated`. Throws InputError if the file has no such animation or if its channels
// are invalid.
void applyAnimation(GltfFile& file, const AnimationTime& when);

// The names of the file's animations, for messages: "`Walk`, `Run` and 3 more".
std::string animationNames(const GltfFile& file);

}  // namespace chromeball
