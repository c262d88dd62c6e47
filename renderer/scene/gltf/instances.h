// SPDX-License-Identifier: Apache-2.0
// Which meshes a glTF file's nodes show, where, and made of what.
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// A scene with the meshes, instances, materials and textures of the tree's nodes. However many
// primitives describe the same geometry, it is stored once.
Scene readInstances(GltfFile& file, const NodeTree& tree);

}  // namespace chromeball
