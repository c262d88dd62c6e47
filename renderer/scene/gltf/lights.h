// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual: directional, point and spot lights.
#pragma once

#include <optional>

#include "image/image.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene.h"

namespace chromeball {

// The lights of the visible nodes in the tree, in world space. Throws InputError if one is invalid.
std::vector<PunctualLight> readLights(GltfFile& file, const NodeTree& tree, LightUnits units);

// The light probe in a glTF file (EXT_lights_image_based).

// The image-based light of the scene as a lat-long map of radiance in the file's axes; nullopt if
// it has none. Uses the sharpest level of the cube map only; the blurred levels and the irradiance
// follow from it by light transport. Throws InputError if the light is invalid.
std::optional<Image> readEnvironment(GltfFile& file);

}  // namespace chromeball
