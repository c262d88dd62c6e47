// SPDX-License-Identifier: Apache-2.0
// Where a photograph of a ball was taken from.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// Seen from the ball (or, for a lens, opposite to where it looks), in degrees: azimuth 0 is +Z, 90
// is +X; elevation 90 is +Y. The camera stands upright: its right is horizontal.
struct CameraPosition {
  double azimuth = 0, elevation = 0;

  // Columns: to the camera's right, up, and from the ball to the camera.
  glm::dmat3 axes() const {
    const double a = azimuth * kPiD / 180, e = elevation * kPiD / 180;
    const glm::dvec3 right(std::cos(a), 0, -std::sin(a));
    const glm::dvec3 back(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    return {right, glm::cross(back, right), back};
  }
};

}  // namespace chromeball
