// SPDX-License-Identifier: Apache-2.0
// Vignetting: images that darken towards their corners.
#pragma once

#include <cmath>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// The place of an image in the view of its camera.

// An image may be a part of the whole picture, whose middle the axis of the camera passes.
struct ViewFrame {
  int x = 0, y = 0;           // of the image's first pixel in the picture
  int width = 0, height = 0;  // of the picture
  double fov = 0;             // vertical, degrees; 0: unknown

  // The size of a pixel in the middle of the picture, at unit distance along the axis.
  double pixelSize() const { return 2 * std::tan(fov * kPiD / 360) / height; }
  double pixelsPerDegree() const { return kPiD / 180 / pixelSize(); }
};

// Multiplies R, G and B by 1 - strength (1 - cos^4 phi), phi = angle to the camera's axis: the
// natural vignetting of a thin lens at strength 1. Needs the frame's fov.
void vignette(Image& image, double strength, const ViewFrame& frame);

// Multiplies R, G and B by the channels of `falloff`, which is stretched over the picture
// (bilinear). One or at least three channels.
void multiplyFalloff(Image& image, const Image& falloff, const ViewFrame& frame);

}  // namespace chromeball
