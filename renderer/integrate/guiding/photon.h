// SPDX-License-Identifier: Apache-2.0
// Light of the probe and of lamps that mirrors, metals and glass throw onto rough surfaces: paths
// from the light (Jensen 1996, "Global Illumination using Photon Maps").
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace chromeball {

// A bounce with a larger pdf, over solid angle, belongs to a narrow lobe. (A diffuse bounce has
// 1 / pi at most, a GGX lobe of roughness 0.45 has 2.)
inline constexpr float kConcentratedPdf = 2;

// Where such a path arrives at a rough surface.
struct Photon {
  vec3 position, normal;
  vec3 direction;  // unit, towards the last surface that reflected or refracted the light
  vec3 emission;   // unit, towards the light on the probe; the same for all light of lamps
  uint32_t chain;  // a hash of the lamp and of the instances that the path met, in order
  float flux;      // luminance
};

}  // namespace chromeball
