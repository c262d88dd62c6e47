// SPDX-License-Identifier: Apache-2.0
// The ways to stand directional lights in for a probe, by the names of the command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"
#include "lighting/light_file.h"

namespace chromeball {

struct LightOptions {
  std::string method;
  std::optional<int> count;  // suns: the most to keep, or all
  uint64_t seed = 0;         // of the methods that throw dice
  bool ambient = false;      // irradiance-fit: with a constant radiance beside the lights
  // irradiance-fit: the fewest lights, at most `count`, whose mean error is not above, percent.
  std::optional<double> maxError = {};
};

std::string lightMethodList();  // "median-cut, ...", for help

// Throws InputError, begun by `location`, where there is no such method.
void checkLightMethod(const std::string& name, std::string_view location);

// Throws InputError where an option is not for the method, or a count is missing.
void checkLightOptions(const LightOptions& options);

struct MadeLights {
  LightRig rig;                     // its `probe` is left empty
  std::optional<double> meanError;  // irradiance-fit: percent
};

// `latLong` is finite and not negative. Throws InputError where the method cannot make so many.
MadeLights makeLights(const Image& latLong, const LightOptions& options);

}  // namespace chromeball
