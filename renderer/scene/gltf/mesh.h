// SPDX-License-Identifier: Apache-2.0
// Converts glTF mesh primitives to meshes, and decodes compressed ones.
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

// KHR_draco_mesh_compression: primitives whose vertices and indices are stored as a Draco mesh.

// Decodes every Draco mesh that has no uncompressed copy in the file, and points the accessors of
// its primitives to the decoded data. Throws InputError if the data is damaged or does not match
// its accessors.
void decodeDraco(GltfFile& file);

// EXT_meshopt_compression and KHR_meshopt_compression: buffer views whose bytes are compressed.

// Replaces every compressed buffer view by one of the decoded bytes. Throws InputError if the
// compressed data or its description is invalid.
void decodeMeshopt(GltfFile& file);

}  // namespace chromeball
