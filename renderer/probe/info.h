// SPDX-License-Identifier: Apache-2.0
// Statistics of a probe, for `probe info`.
#pragma once

#include <vector>

#include "image/image.h"
#include "probe/clipping.h"
#include "probe/mapping.h"
#include "probe/sun.h"

namespace chromeball {

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
  double robustRange = 0;  // clipping.h, as the following
  Plateau plateau;
  double lostIfClippedAtWhite = 0;
  std::vector<Sun> suns;  // sun_extraction.h: in order of decreasing irradiance
  std::vector<BrightestTexels> brightestTexels;  // of 1, 10 and 100 texels, and of 1% of all
};

// `latLong` is finite and not negative; radiance is constant over each texel.
ProbeInfo probeInfo(const Image& latLong);

}  // namespace chromeball
