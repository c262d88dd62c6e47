// SPDX-License-Identifier: Apache-2.0
// Lights infinitely far away: the elements of constellations and fits, and extracted suns.
#pragma once

#include <vector>

#include "math/rotation.h"

namespace chromeball {

struct DirectionalLight {
  vec3 direction;   // unit, from the scene to the light
  Rgb irradiance;   // on a surface that faces it, W/m^2
  float angle = 0;  // angular diameter, degrees; 0: a delta light
};

using Constellation = std::vector<DirectionalLight>;

// Those of a probe that is turned.
inline Constellation turned(Constellation lights, const Rotation& rotation) {
  for (DirectionalLight& light : lights) light.direction = rotation(light.direction);
  return lights;
}

}  // namespace chromeball
