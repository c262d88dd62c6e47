// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual: directional, point and spot lights.
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// The lights of the visible nodes in the tree, in world space. Throws InputError if one is invalid.
std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units);

}  // namespace chromeball
