// Turns glTF mesh primitives into meshes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_file.h"
#include "scene/gltf_material.h"
#include "scene/scene.h"

namespace chromeball {

// How a node poses its mesh: morph weights, and for a skinned one the joints (gltf_pose.h).
struct Pose {
  std::vector<double> weights;
  std::vector<glm::dmat4> joints;  // empty: not skinned
};

// Whether the skin moves this primitive; if so readPrimitive returns it in world space.
bool isSkinned(const tinygltf::Primitive& primitive, const Pose& pose);

// Reads a primitive with its normals mended and its tangents complete. Nothing where it has no
// triangles (points, lines, no positions): a warning has then been said.
std::optional<Mesh> readPrimitive(GltfFile& file, const tinygltf::Primitive& primitive,
                                  const Pose& pose, const std::string& where,
                                  MaterialReader& materials);

}  // namespace chromeball
