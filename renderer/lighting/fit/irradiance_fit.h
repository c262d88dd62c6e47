// SPDX-License-Identifier: Apache-2.0
// `irradiance-fit`: a few directional lights with nearly the irradiance of a probe.
#pragma once

#include <optional>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"

namespace chromeball {

struct IrradianceFit {
  Constellation lights;                // at most as many as requested; none is black
  Rgb ambient{0};                      // radiance from all directions; 0 unless requested
  double meanError = 0, maxError = 0;  // percent, over 20480 normals (light_descent.h)
};

inline constexpr int kMaxFittedLights = 256;

struct FitOptions {
  int count = 8;
  bool ambient = false;
  // If set, `count` is ignored: the result is the smallest number of lights whose mean error does
  // not exceed this, or maxCount lights if none does.
  std::optional<double> maxErrorPercent;
  int maxCount = kMaxFittedLights;
};

// The lights that minimise the squared difference of irradiance over all orientations (Madsen et
// al. 2003; Madsen and Laursen 2007). Adds lights one by one in the direction that reduces the
// difference most, and then moves all lights (alternating descent conditional gradient: Boyd,
// Schiebinger and Recht 2017). The mean error never increases with the count. `latLong` must be
// finite and not negative. The result does not depend on the number of threads. Throws InputError
// if a count is negative.
IrradianceFit fitIrradiance(const Image& latLong, const FitOptions& options);

}  // namespace chromeball
