// SPDX-License-Identifier: Apache-2.0
// A glTF file's animation, evaluated at one time.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

// Sets translation, rotation, scale and morph weights of the animated nodes to their state at the
// given time (glTF 2.0, 3.11 and appendix C); constant before the first key and after the last.
// Marks them as `animated`. Throws InputError if the file has no such animation or if its channels
// are invalid.
void applyAnimation(GltfFile& file, const AnimationTime& when);

// As animationChanges() (load_gltf.h), of an open file whose animation applyAnimation() accepts.
std::vector<double> changesAfter(GltfFile& file, const AnimationTime& when, double seconds);

// The name of an animation, or its index if it has none.
std::string animationName(const std::vector<tinygltf::Animation>& animations, size_t index);

// The names of the file's animations, for messages: "`Walk`, `Run` and 3 more".
std::string animationNames(const GltfFile& file);

// The pose that a node gives its mesh.
struct Pose {
  std::span<const double> weights;     // of the morph targets
  std::span<const glm::dmat4> joints;  // joint matrices of the skin; empty: not skinned
};

// Adds weights[i] times morph target i to positions, normals and tangents (glTF 2.0, 3.7.2.2);
// warns of other displacements.
void applyMorphTargets(GltfFile& file, const tinygltf::Primitive& primitive,
                       std::span<const double> weights, const std::string& where, Mesh& mesh);

// Linear blend skinning: p' = sum over joints of w_i joints[i] p, where joints[i] is the joint's
// world matrix times its inverse bind matrix (glTF 2.0, 3.7.3). The result is in world space.
void applySkin(GltfFile& file, const tinygltf::Primitive& primitive,
               std::span<const glm::dmat4> joints, const std::string& where, Mesh& mesh);

}  // namespace chromeball
