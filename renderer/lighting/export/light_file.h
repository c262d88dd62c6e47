// SPDX-License-Identifier: Apache-2.0
// Writes directional lights to files, for other programs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

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

// The ratio of irradiance, on a surface that faces a disc of constant radiance, to that radiance:
// pi sin^2(a / 2) for a diameter a. Madsen and Laursen (2007, eq. 5) take pi (a / 2)^2 steradians,
// 2.392e-4 for 1 degree, which is 0.25% more at 10 degrees.
double projectedSolidAngle(double degrees);

enum class LightFormat { Json, Gltf, Csv, OpenGl };

// json, gltf, csv or opengl; if `name` is empty, by the extension of `path`: .json, .gltf, .csv or
// .h. Throws InputError, which starts with `location` if there is a name.
LightFormat lightFormat(const std::filesystem::path& path, std::string_view name,
                        std::string_view location);

// Writes atomically. Throws RunError if a light is not finite or writing fails.
//   Json    {"probe", "method", "ambient": [r, g, b] if any, "lights": [{"direction": [x, y, z],
//           "irradiance": [r, g, b], "angle": degrees}, ...]}; lights with an angle also have
//           "radiance": [r, g, b] (projectedSolidAngle)
//   Gltf    KHR_lights_punctual: for each light a directional light and a node whose -Z points
//   along
//           its rays. Intensity x colour is the irradiance (x 683 lux per W/m^2 for photometric
//           units); the colour's largest component is 1. Ambient light and angles, which the
//           extension lacks, are in extras.
//   Csv     header x,y,z,r,g,b,angle, then a line per light; without the ambient light
//   OpenGl  a C header
void writeLights(const std::filesystem::path& path, const LightRig& rig, LightFormat format);

// Writes the lights in the format of the extension. Throws InputError for another extension.
void writeLights(const std::filesystem::path& path, const LightRig& rig);

// Directional lights as a C header for OpenGL's fixed-function lighting.

// Arrays for glLightfv() and glLightModelfv(), and a function that passes them (Madsen et al. 2003,
// eq. 4 to 6). A surface with the coefficients kd = ka = 1 then has the radiance of a white
// Lambertian surface: L_j = E_j / pi of each light, L_A = the ambient radiance.
std::string formatOpenGl(const LightRig& rig);

// Reads lists of directional lights, as writeLights() writes them (.json), perhaps edited since.

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
