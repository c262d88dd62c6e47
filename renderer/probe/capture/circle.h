// SPDX-License-Identifier: Apache-2.0
// A circle in a photograph.
#pragma once

#include "math/vec.h"

namespace chromeball {

// In pixels, x right and y down from the top left corner of the image; texel (x, y) covers
// [x, x + 1) x [y, y + 1).
struct Circle {
  glm::dvec2 centre;
  double radius;
};

// The share of the circle's area that is inside an image of this size, to 1%.
double shareInside(const Circle& circle, int width, int height);

}  // namespace chromeball
