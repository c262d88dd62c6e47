// SPDX-License-Identifier: Apache-2.0
// The node hierarchy of a glTF file, flattened.
#pragma once

#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

struct NodeTree {
  std::vector<glm::dmat4> toWorld;  // of every node in the file
  std::vector<int> inScene;         // the nodes of the scene to show, parents before children
  std::vector<std::string> names;   // of every node; never empty
  std::vector<int> parents;         // of every node; -1: a root
};

// Composes the transforms of all nodes, `placement` outermost, seen from `origin`. Throws
// InputError where the nodes are not trees, or a transform is not affine and finite.
NodeTree readNodes(const GltfFile& file, const Transform& placement, const glm::dvec3& origin);

// False where the matrix flattens space, or does once it is rounded to float.
bool isInvertible(const glm::dmat4& m);

}  // namespace chromeball
