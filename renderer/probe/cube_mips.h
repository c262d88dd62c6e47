// SPDX-License-Identifier: Apache-2.0
// A probe as the chain of prefiltered cube maps that real-time renderers look up by roughness.
#pragma once

#include <string_view>
#include <vector>

#include "image/image.h"

namespace chromeball {

// Which roughness a level k of n has: Khronos' glTF sample viewer k / (n - 1); Filament
// 1 - sqrt(1 - k / (n - 1)), the inverse of its roughness (2 - roughness).
enum class MipRoughness { Khronos, Filament };

// "khronos" or "filament". Throws InputError, begun by `location`.
MipRoughness parseMipRoughness(std::string_view text, std::string_view location);

struct CubeLevel {
  double roughness;  // GGX, alpha = roughness^2
  Image faces;       // six faces, one below another: +X -X +Y -Y +Z -Z
};

// Level 0 is the map itself, each texel a mean over its solid angle; the others are convolved by
// ZonalKernel::ggx, at the texels' centres. Faces halve from `size` to 16 (to `size` if that is
// less). Texels are where OpenGL and Vulkan look up the direction of this program's axes; seen from
// inside of the cube, faces are mirrored. Throws InputError unless `size` is a power of two from 1
// to 4096.
std::vector<CubeLevel> cubeMips(const Image& latLong, int size, MipRoughness roughness);

}  // namespace chromeball
