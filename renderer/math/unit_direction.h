// SPDX-License-Identifier: Apache-2.0
// Directions of vectors whose squared length may exceed the range of a double.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/vec.h"

namespace chromeball {

// The direction of a finite vector; 0 for 0.
inline glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double longest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return longest > 0 ? glm::normalize(v / longest) : glm::dvec3(0);
}

}  // namespace chromeball
