// SPDX-License-Identifier: Apache-2.0
// Poses a mesh: morph targets and skinning.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

// The pose that a node gives its mesh.
struct Pose {
  std::span<const double> weights;     // of the morph targets
  std::span<const glm::dmat4> joints;  // joint matrices of the skin; empty: not skinned
};

// Adds weights[i] times morph target i to positions, normals and tangents (glTF 2.0, 3.7.2.2).
void applyMorphTargets(GltfFile& file, const tinygltf::Primitive& primitive,
                       std::span<const double> weights, const std::string& where, Mesh& mesh);

// Linear blend skinning: p' = sum over joints of w_i joints[i] p, where joints[i] is the joint's
// world matrix times its inverse bind matrix (glTF 2.0, 3.7.3). The result is in world space.
void applySkin(GltfFile& file, const tinygltf::Primitive& primitive,
               std::span<const glm::dmat4> joints, const std::string& where, Mesh& mesh);

}  // namespace chromeball
