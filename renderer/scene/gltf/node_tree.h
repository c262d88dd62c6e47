// SPDX-License-Identifier: Apache-2.0
// The node hierarchy of a glTF file, flattened, and what is at its nodes: instances and lights.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model_cache.h"
#include "scene/scene.h"

namespace chromeball {

struct NodeTree {
  std::vector<glm::dmat4> toWorld;  // of every node in the file
  std::vector<int> inScene;         // the nodes of the default scene, parents before children
  std::vector<int> visible;         // those whose meshes and lights are seen (KHR_node_visibility)
  std::vector<std::string> names;   // of every node in the file; never empty
  std::vector<int> parents;         // of every node in the file; -1: a root
  std::vector<bool> moves;          // of every node: the animation moves it or changes its weights
};

// Composes the transforms of all nodes: the parents', then `placement`, then a translation by
// -origin. Throws InputError if the nodes do not form trees, or if a transform is not affine and
// finite.
NodeTree readNodes(const GltfFile& file, const Transform& placement, const glm::dvec3& origin);

// A scene with the meshes, instances, materials and textures of the visible nodes in the tree.
// Geometry that several primitives share is stored once. `cache` receives the data read; null:
// none.
Scene readInstances(GltfFile& file, const NodeTree& tree, ModelCache* cache);

// KHR_lights_punctual: directional, point and spot lights.

// The lights of the visible nodes in the tree, in world space. Throws InputError if one is invalid.
std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units);

// The light probe in a glTF file (EXT_lights_image_based).

// The image-based light of the scene as a lat-long map of radiance in the file's axes; nullopt if
// it has none. Uses the sharpest level of the cube map only; the blurred levels and the irradiance
// follow from it by light transport. Throws InputError if the light is invalid.
std::optional<Image> readEnvironment(GltfFile& file);

}  // namespace chromeball
