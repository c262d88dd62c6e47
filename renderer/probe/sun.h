// SPDX-License-Identifier: Apache-2.0
// A sun: a distant disc of constant radiance.
#pragma once

#include "math/vec.h"

namespace chromeball {

struct Sun {
  glm::dvec3 direction;   // unit, towards its centre
  glm::dvec3 irradiance;  // on a surface that faces it
  double angle;           // angular diameter, degrees; above 0

  glm::dvec3 radiance() const;  // irradiance / (pi sin^2(angle / 2))

  // Irradiance on a surface with unit `normal`, whose horizon may cut the disc.
  glm::dvec3 irradianceOn(const glm::dvec3& normal) const;
};

}  // namespace chromeball
