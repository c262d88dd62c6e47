// SPDX-License-Identifier: Apache-2.0
// Estimate of the energy lost to the depth limits of a render.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// Sums of luminance over paths. `byDepth` and `byTransmission` are unbiased estimates of the light
// beyond the limit that a path reaches first (maxDepth or maxTransmissionDepth), up to the number
// of extra bounces of PathTracer::estimateDepthCut().
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

  // `cut` as a fraction of all light, found and cut.
  double fraction(double cut) const {
    return cut > 0 ? cut / (found + byDepth + byTransmission) : 0;
  }
};

}  // namespace chromeball
