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

// Directions need not be unit vectors. Angles, in degrees, are 0 or kLeastListedAngle to
// kMaxListedAngle. A light without `irradiance` needs `radiance` and `angle`; one that has both
// must have an irradiance of Sun::radiance() within 1%. Other keys are refused, as they are
// typing errors. Throws InputError for a file that is no such list.
inline constexpr double kLeastListedAngle = 0.01, kMaxListedAngle = 90;
LightList readLights(const std::filesystem::path& path);

}  // namespace chromeball
