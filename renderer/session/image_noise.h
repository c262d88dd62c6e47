// SPDX-License-Identifier: Apache-2.0
// The noise of an image.
#pragma once

#include "film/noise.h"

namespace chromeball {

struct ImageNoise {
  double noise, median, p95;  // fractions (film/noise.h)
  Image variance;             // of each pixel's mean, RGB

  explicit ImageNoise(const PixelErrors& errors) {
    const std::vector<glm::dvec4> squared = squaredStandardErrors(errors);
    const NoiseQuantiles quantiles = noiseQuantiles(errors, squared);
    noise = estimateNoise(errors).noise;
    median = quantiles.median, p95 = quantiles.p95;
    variance = varianceImage(squared, errors.width, errors.height);
  }
};

}  // namespace chromeball
