// SPDX-License-Identifier: Apache-2.0
// Reads lists of directional lights, as writeLights() writes them (.json), perhaps edited since.
#pragma once

#include <filesystem>
#include <optional>

#include "lighting/constellation/directional_light.h"

namespace chromeball {

struct LightList {
  Constellation lights;
  std::optional<Rgb> ambient;  // radiance from all directions
};

// Directions need not be unit vectors. A light without `irradiance` needs `radiance` and `angle`
// (degrees, 0 to kMaxListedAngle); one that has both must have an irradiance of discSolidAngle()
// (light_file.h) times its radiance, within 1%. Throws InputError for a file that is no such list.
inline constexpr double kMaxListedAngle = 90;
LightList readLights(const std::filesystem::path& path);

}  // namespace chromeball
