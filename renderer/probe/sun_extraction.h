// SPDX-License-Identifier: Apache-2.0
// Concentrated sources, taken out of a probe as discs of even radiance.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/sun.h"

namespace chromeball {

struct SunExtraction {
  std::vector<Sun> suns;  // by irradiance, the greatest first
  Image remainder;        // the map without them, three channels
};

// A sun is a connected region of texels more than 2000 times as luminous as the mean over the
// sphere (less on maps too coarse to resolve a sun), no wider than 6 degrees unless it is a texel
// or two, which with its glow adds at least 1% to the flux. The glow reaches to where the median of
// a ring around the sun is at most 20 times the mean, but no further than 6 degrees. Inside, what
// exceeds the radiance interpolated from the ring is the sun's.
//
// The disc has the irradiance of the light removed, exactly, and its mean distance from the centre,
// which keeps the irradiance of surfaces that see half of the disc as well: together, suns and
// remainder have the irradiance of the map to within 0.1% of its mean for every normal, at 1024 x
// 512 texels (taken as constant) and more.
//
// `latLong` is finite and not negative, and has at least three channels.
SunExtraction extractSuns(const Image& latLong);

}  // namespace chromeball
