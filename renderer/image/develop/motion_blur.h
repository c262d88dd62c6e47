// SPDX-License-Identifier: Apache-2.0
// Streaks: an image blurred along a line, as if the camera had turned during the exposure.
#pragma once

#include "image/image.h"

namespace chromeball {

inline constexpr double kMaxMotion = 4096;

struct Motion {
  double length;  // pixels
  double angle;   // degrees, counter-clockwise from the right
};

// The mean along a segment with its middle in the pixel. Each step along the longer axis of the
// segment takes two pixels by linear interpolation, weighted by the segment's share of the step:
// exactly a box if the segment is horizontal or vertical. The image is mirrored at its borders
// (gaussian_line.h), so that the sum of its pixels is kept; not in the corners, if the segment is
// neither horizontal nor vertical. Infinity and NaN spread.
Image blurMotion(const Image& image, const Motion& motion);

}  // namespace chromeball
