// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: one node that shows its mesh many times.
#pragma once

#include <vector>

#include "scene/gltf/gltf_file.h"

namespace chromeball {

// Where the node shows its mesh, relative to the node: the one identity where it does not use the
// extension.
std::vector<glm::dmat4> readInstanceTransforms(GltfFile& file, const tinygltf::Node& node,
                                               const std::string& where);

}  // namespace chromeball
