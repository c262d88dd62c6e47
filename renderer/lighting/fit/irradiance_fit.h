// SPDX-License-Identifier: Apache-2.0
// A few directional lights that light as a probe does.
#pragma once

#include <optional>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"

namespace chromeball {

struct IrradianceFit {
  Constellation lights;                // as many as were asked for; some may be black
  Rgb ambient{0};                      // radiance from everywhere; 0 unless asked for
  double meanError = 0, maxError = 0;  // percent, of 20480 normals (light_error.h)
};

inline constexpr int kMaxFittedLights = 256;

struct FitOptions {
  int count = 8;
  bool ambient = false;
  // Instead of `count`: the fewest lights, up to maxCount, whose mean error is not above this.
  // Where maxCount lights do not reach it, they are the result.
  std::optional<double> maxErrorPercent;
  int maxCount = kMaxFittedLights;
};

// The lights that minimise the squared difference in irradiance over all orientations (Madsen et
// al. 2003), found by adding one light after another where it helps most and moving all of them
// after each (alternating descent conditional gradient: Boyd, Schiebinger and Recht 2017). The mean
// error never grows with the count. `latLong` is finite and not negative. The same result for any
// number of threads. Throws InputError where a count is negative.
IrradianceFit fitIrradiance(const Image& latLong, const FitOptions& options);

}  // namespace chromeball
