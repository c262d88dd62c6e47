// SPDX-License-Identifier: Apache-2.0
// How much of a probe's light an image with less range would lose, and whether it has been lost
// already. Maps are lat-long, finite and not negative; radiance is constant over each texel.
#pragma once

#include <cstddef>

#include "image/image.h"

namespace chromeball {

// The texels whose largest channel is within 0.2% of the largest of all: an encoding in 8 bits of
// mantissa spreads clipped texels as much.
struct Plateau {
  size_t texels = 0;
  double solidAngle = 0;  // steradians
  // At least 8 texels and twice the solid angle of the sun's disc, but not above 90% of the sphere;
  // and fewer texels from 0.2% to 1% below the maximum than within 0.2%: around a smooth maximum
  // there are four times as many. A lamp of constant radiance looks clipped as well.
  bool looksClipped = false;
};
Plateau plateau(const Image& latLong);

// The ratio of the luminances that 1% of the sphere exceeds, and that 1% is below: neither suns nor
// single texels change it. Accurate to 2%; 0 if less than 1% of the sphere is lit, else infinite if
// more than 1% is black.
double robustRange(const Image& latLong);

// The fraction of the light, of red, green and blue together, that is lost if the map is exposed so
// that its mean luminance over the sphere is 0.18, and each channel is clipped at 1. It is that of
// the irradiance too, in the mean over all normals. 0 for a black map.
double lostIfClippedAtWhite(const Image& latLong);

}  // namespace chromeball
