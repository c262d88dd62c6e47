// SPDX-License-Identifier: Apache-2.0
// Directional lights as files, for other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lighting/constellation/directional_light.h"
#include "scene/light.h"

namespace chromeball {

// What `chromeball lights` makes of a probe.
struct LightRig {
  std::string probe, method;   // the file, and the name of the method
  std::optional<Rgb> ambient;  // radiance from everywhere, beside the lights
  Constellation lights;
  LightUnits units = LightUnits::Photometric;  // of .gltf
};

// Writes atomically; the extension decides the format. Throws InputError where it is none of these,
// RunError where a light is not finite or writing fails.
//   .json  {"probe", "method", "ambient": [r, g, b] where there is one, "lights": [{"direction":
//          [x, y, z], "irradiance": [r, g, b], "angle": degrees}, ...]}
//   .gltf  KHR_lights_punctual: for each a directional light and a node, whose -Z is the way its
//          light goes. Intensity times colour is the irradiance, at 683 lux to the W/m^2 where the
//          units are photometric; the colour's largest component is 1.
//          Ambient light and angles, which the format does not have, are in extras.
//   .csv   a line a light, under the header x,y,z,r,g,b,angle; the ambient light is left out
void writeLights(const std::filesystem::path& path, const LightRig& rig);

}  // namespace chromeball
