// SPDX-License-Identifier: Apache-2.0
// The environment a glTF file brings along (EXT_lights_image_based).
#pragma once

#include <optional>

#include "image/image.h"
#include "scene/gltf/gltf_file.h"

namespace chromeball {

// The scene's image-based light as a lat-long map of radiance in the file's axes; nullopt where it
// names none. It is made of the sharpest level of the cube map; the blurred ones and the irradiance
// follow from that by light transport. Throws InputError where the light is not well-formed.
std::optional<Image> readEnvironment(GltfFile& file);

}  // namespace chromeball
