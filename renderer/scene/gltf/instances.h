// SPDX-License-Identifier: Apache-2.0
// The meshes, materials and transforms of a glTF file's nodes.
#pragma once

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// A scene with the meshes, instances, materials and textures of the visible nodes in the tree.
// Geometry that several primitives share is stored once. `cache` receives what is read; null: none.
Scene readInstances(GltfFile& file, const NodeTree& tree, ModelCache* cache);

}  // namespace chromeball
