// SPDX-License-Identifier: Apache-2.0
// Converts glTF mesh primitives to meshes.
#pragma once

#include <optional>
#include <string>

#include "scene/gltf/animation.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"
#include "scene/scene.h"

namespace chromeball {

// Whether the skin deforms this primitive; if so, readPrimitive() returns it in world space.
bool isSkinned(const tinygltf::Primitive& primitive, const Pose& pose);

// Whether the primitive's mode and attributes define triangles. Warns if not.
bool hasTriangles(GltfFile& file, const tinygltf::Primitive& primitive, const std::string& where);

MeshRecipe recipeOf(const tinygltf::Primitive& primitive, const Pose& pose,
                    const Material& material);

// Reads a primitive with triangles and the attributes that the material needs, with repaired
// normals and complete tangents. Returns nullopt and warns if the indices form no triangle.
std::optional<Mesh> readPrimitive(GltfFile& file, const tinygltf::Primitive& primitive,
                                  const Pose& pose, const std::string& where,
                                  const Material& material);

}  // namespace chromeball
