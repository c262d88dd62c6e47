// SPDX-License-Identifier: Apache-2.0
// Rotation about +Y, as a probe's: counter-clockwise seen from above.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

inline glm::dvec3 turnedAboutY(const glm::dvec3& d, double degrees) {
  const double angle = degrees * kPiD / 180, sine = std::sin(angle), cosine = std::cos(angle);
  return {d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine};
}

}  // namespace chromeball
