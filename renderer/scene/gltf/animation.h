// SPDX-License-Identifier: Apache-2.0
// A glTF file's animation, evaluated at one time.
#pragma once

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Sets the translation, rotation, scale and morph weights of the nodes that the animation moves to
// what they are at its time (glTF 2.0, 3.11 and appendix C); before the first key and after the
// last one they stand still. Throws InputError where the file has no such animation, or its
// channels are not well-formed.
void applyAnimation(GltfFile& file, const AnimationTime& when);

// "`Walk`, `Run` and 3 more": how to ask for the file's animations.
std::string animationNames(const GltfFile& file);

}  // namespace chromeball
