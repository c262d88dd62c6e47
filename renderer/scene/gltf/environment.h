// SPDX-License-Identifier: Apache-2.0
// The light probe in a glTF file (EXT_lights_image_based).
#pragma once

#include <optional>

#include "image/image.h"
#include "scene/gltf/gltf_file.h"

namespace chromeball {

// The image-based light of the scene as a lat-long map of radiance in the file's axes; nullopt if
// it has none. Uses the sharpest level of the cube map only; the blurred levels and the irradiance
// follow from it by light transport. Throws InputError if the light is invalid.
std::optional<Image> readEnvironment(GltfFile& file);

}  // namespace chromeball
