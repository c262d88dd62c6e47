// SPDX-License-Identifier: Apache-2.0
// Turns glTF mesh primitives into meshes.
#pragma once

#include <compare>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene.h"

namespace chromeball {

// How a node poses its mesh: morph weights, and for a skinned one the joints (gltf_pose.h).
struct Pose {
  std::span<const double> weights;
  std::span<const glm::dmat4> joints;  // empty: not skinned
};

// Whether the skin moves this primitive; if so readPrimitive returns it in world space.
bool isSkinned(const tinygltf::Primitive& primitive, const Pose& pose);

// Whether the primitive's mode and attributes make triangles; where not, a warning has been said.
bool hasTriangles(GltfFile& file, const tinygltf::Primitive& primitive, const std::string& where);

// All that an unskinned mesh is made from: primitives with equal recipes have equal meshes.
struct MeshRecipe {
  int mode, indices;
  std::map<std::string, int> attributes;
  std::vector<std::map<std::string, int>> targets;
  std::vector<double> weights;
  std::vector<int> uvSets;             // that the material reads
  std::vector<uint32_t> tangentSpace;  // UV set and the bits of the transform; empty: none
  bool hasAlpha;                       // opaque surfaces are traced faster among themselves

  auto operator<=>(const MeshRecipe&) const = default;
};
MeshRecipe recipeOf(const tinygltf::Primitive& primitive, const Pose& pose,
                    const Material& material);

// Reads a primitive that has triangles, with what the material needs of it: normals mended,
// tangents complete. Nothing where the indices make no triangle: a warning has then been said.
std::optional<Mesh> readPrimitive(GltfFile& file, const tinygltf::Primitive& primitive,
                                  const Pose& pose, const std::string& where,
                                  const Material& material);

}  // namespace chromeball
