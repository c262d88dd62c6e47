// SPDX-License-Identifier: Apache-2.0
// Writes directional lights to files, for other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "lighting/constellation/directional_light.h"
#include "scene/light.h"

namespace chromeball {

// The lights that replace a probe, and how they were made.
struct LightRig {
  std::string probe, method;   // the probe's file, and the name of the method (methods.h)
  std::optional<Rgb> ambient;  // additional constant radiance from all directions
  Constellation lights;
  LightUnits units = LightUnits::Photometric;  // in .gltf
};

// Writes atomically; the extension decides the format. Throws InputError for another extension,
// RunError if a light is not finite or writing fails.
//   .json  {"probe", "method", "ambient": [r, g, b] if any, "lights": [{"direction": [x, y, z],
//          "irradiance": [r, g, b], "angle": degrees}, ...]}
//   .gltf  KHR_lights_punctual: for each light a directional light and a node whose -Z points along
//          its rays. Intensity x colour is the irradiance (x 683 lux per W/m^2 for photometric
//          units); the colour's largest component is 1. Ambient light and angles, which the
//          extension lacks, are in extras.
//   .csv   header x,y,z,r,g,b,angle, then a line per light; without the ambient light
void writeLights(const std::filesystem::path& path, const LightRig& rig);

}  // namespace chromeball
