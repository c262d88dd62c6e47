// SPDX-License-Identifier: Apache-2.0
// The error of irradiance of lights that replace a probe (Madsen and Laursen 2007, section 5).
#pragma once

#include <span>
#include <vector>

#include "lighting/constellation/directional_light.h"
#include "probe/mapping.h"

namespace chromeball {

// Irradiance, W/m^2, on surfaces with these unit normals, from the lights (as if their angles were
// 0) and the radiance `ambient` from all directions.
std::vector<dvec3> irradianceOf(const Constellation& lights, const Rgb& ambient,
                                std::span<const vec3> normals);

// Percent of the probe's mean irradiance (over normals and RGB).
struct LightError {
  double mean, max;
};

// Mean and maximum over the normals of |E_lights - E_probe| per channel, averaged over RGB. Both
// lists have one irradiance per normal. For a black probe the percentage is 0 if the lights are
// black too, else infinite.
LightError lightError(std::span<const dvec3> lights, std::span<const dvec3> probe);

}  // namespace chromeball
