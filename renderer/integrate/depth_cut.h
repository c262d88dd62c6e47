// SPDX-License-Identifier: Apache-2.0
// The light that the limits of depth cut from a render.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// Sums of luminance over paths. `byDepth` and `byTransmission` are unbiased estimates of what paths
// would find beyond the limit that they reach first, within the bounces that
// PathTracer::estimateDepthCut() adds.
struct DepthCut {
  double found = 0, byDepth = 0, byTransmission = 0;

  void addFound(const Rgb& radiance) {
    if (isFinite(radiance)) found += double(luminance(radiance));
  }
  void add(bool isOfDepth, double luminance) {
    (isOfDepth ? byDepth : byTransmission) += luminance;
  }
  void add(const DepthCut& other) {
    found += other.found, byDepth += other.byDepth, byTransmission += other.byTransmission;
  }

  // Fraction of all light, found or not.
  double fraction(double cut) const {
    return cut > 0 ? cut / (found + byDepth + byTransmission) : 0;
  }
};

}  // namespace chromeball
