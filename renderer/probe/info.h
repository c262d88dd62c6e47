// SPDX-License-Identifier: Apache-2.0
// Statistics of a probe, for `probe info`.
#pragma once

#include <cstddef>
#include <vector>

#include "image/image.h"
#include "probe/mapping.h"
#include "probe/sun_extraction.h"

namespace chromeball {

// The light of a probe that an image with less range would lose, and whether it has been lost
// already. Maps are lat-long, finite and not negative; radiance is constant over each texel.

// The texels whose largest channel is within 0.2% of the largest of all: an encoding in 8 bits of
// mantissa spreads clipped texels as much.
struct Plateau {
  size_t texels = 0;
  double solidAngle = 0;  // steradians
  // True if the maximum covers at least 8 texels and twice the solid angle of the sun's disc, but
  // not above 90% of the sphere; and if there are fewer texels from 0.2% to 1% below the maximum
  // than within 0.2%: around a smooth maximum there are four times as many. A lamp of constant
  // radiance looks clipped as well.
  bool looksClipped = false;
};
Plateau plateau(const Image& latLong);

// The ratio of the luminances that 1% of the sphere exceeds, and that 1% is below: neither suns nor
// single texels change it. Accurate to 2%; 0 if less than 1% of the sphere is lit, else infinite if
// more than 1% is black.
double robustRange(const Image& latLong);

// The fraction of the light, of red, green and blue together, that is lost if the map is exposed so
// that its mean luminance over the sphere is 0.18, and each channel is clipped at 1. The same
// fraction of irradiance is lost, in the mean over all normals. 0 for a black map.
double lostIfClippedAtWhite(const Image& latLong);

struct BrightestTexels {
  size_t count;
  double fraction;  // of the integral of luminance over the sphere; 0 for a black probe
};

struct ProbeInfo {
  Rgb min{0}, max{0};
  dvec3 mean{0};            // of the texels
  dvec3 meanRadiance{0};    // over the sphere
  double dynamicRange = 0;  // largest luminance over the smallest positive one; 0 for a black probe
  dvec3 brightestDirection{0};
  Rgb brightest{0};
  double maxOverMean = 0;  // largest luminance over the mean over the sphere; 0 for a black probe
  double robustRange = 0;  // as the following: of the functions above
  Plateau plateau;
  double lostIfClippedAtWhite = 0;
  std::vector<Sun> suns;  // sun_extraction.h: in order of decreasing irradiance
  std::vector<BrightestTexels> brightestTexels;  // of 1, 10 and 100 texels, and of 1% of all
};

// `latLong` is finite and not negative; radiance is constant over each texel.
ProbeInfo probeInfo(const Image& latLong);

}  // namespace chromeball
