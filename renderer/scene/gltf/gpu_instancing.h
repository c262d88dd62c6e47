// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: a node with several instances of its mesh.
#pragma once

#include <vector>

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// The transforms of the node's instances, relative to the node; one identity if it does not use the
// extension, or without transforms.
std::vector<glm::dmat4> readInstanceTransforms(GltfFile& file, const tinygltf::Node& node,
                                               const std::string& where);

}  // namespace chromeball
