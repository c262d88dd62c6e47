// SPDX-License-Identifier: Apache-2.0
// What rounding to float takes from a vector.
#pragma once

#include "math/vec.h"

namespace chromeball {

// v - vec3(v). GCC 12 takes it for 0 where it vectorizes, which the volatile number prevents.
inline glm::dvec3 floatRest(const glm::dvec3& v) {
  glm::dvec3 rest;
  for (int k = 0; k < 3; ++k) {
    const volatile float rounded = float(v[k]);
    rest[k] = v[k] - double(rounded);
  }
  return rest;
}

}  // namespace chromeball
