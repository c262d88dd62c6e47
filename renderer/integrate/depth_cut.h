// SPDX-License-Identifier: Apache-2.0
// How much light the limits of depth keep from a picture.
#pragma once

#include <cmath>

#include "math/vec.h"

namespace chromeball {

// Enough for every way through a few vessels, one behind another.
inline constexpr int kUsualTransmissionDepth = 64;

// Sums of luminance over paths. `byDepth` and `byTransmission` are estimates, without bias, of what
// paths would find beyond the limit that they reach first; light that takes more than the bounces
// of measureCut() (path.h) to find is not among it.
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

  // Share of all light, found or not.
  double fraction(double cut) const {
    return cut > 0 ? cut / (found + byDepth + byTransmission) : 0;
  }
};

}  // namespace chromeball
