// SPDX-License-Identifier: Apache-2.0
// The meshes, materials and transforms of a glTF file's nodes.
#pragma once

#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// A scene with the meshes, instances, materials and textures of the visible nodes in the tree.
// Geometry that several primitives share is stored once. `cache` receives what is read; null: none.
Scene readInstances(GltfFile& file, const NodeTree& tree, ModelCache* cache);

// EXT_mesh_gpu_instancing: a node with several instances of its mesh.

// The transforms of the node's instances, relative to the node; one identity if it does not use the
// extension, or without transforms.
std::vector<glm::dmat4> readInstanceTransforms(GltfFile& file, const tinygltf::Node& node,
                                               const std::string& where);

}  // namespace chromeball
