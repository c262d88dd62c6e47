// SPDX-License-Identifier: Apache-2.0
// Puts a mesh into its pose: morph targets at their weights, skins at their joints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

// Adds weights[i] times morph target i to positions, normals and tangents (glTF 2.0, 3.7.2.2).
void applyMorphTargets(GltfFile& file, const tinygltf::Primitive& primitive,
                       std::span<const double> weights, const std::string& where, Mesh& mesh);

// Linear blend skinning: p' = sum over joints of w_i joints[i] p, where joints[i] is the joint's
// world matrix times its inverse bind matrix (glTF 2.0, 3.7.3). The result is in world space.
void applySkin(GltfFile& file, const tinygltf::Primitive& primitive,
               std::span<const glm::dmat4> joints, const std::string& where, Mesh& mesh);

}  // namespace chromeball
