// SPDX-License-Identifier: Apache-2.0
// How an image lies in the view of its camera.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// An image may be a part of the whole picture, whose middle the axis of the camera passes.
struct ViewFrame {
  int x = 0, y = 0;           // of the image's first pixel in the picture
  int width = 0, height = 0;  // of the picture
  double fov = 0;             // vertical, degrees; 0: unknown

  // Of a pixel in the middle of the picture: its size at unit distance along the axis.
  double pixelSize() const { return 2 * std::tan(fov * kPiD / 360) / height; }
  double pixelsPerDegree() const { return kPiD / 180 / pixelSize(); }
};

}  // namespace chromeball
