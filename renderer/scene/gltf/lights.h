// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual: the lights that nodes carry.
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// The lights of the tree's nodes, in world space. Throws InputError where one is not well-formed.
std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units);

}  // namespace chromeball
