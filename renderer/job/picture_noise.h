// SPDX-License-Identifier: Apache-2.0
// The numbers that say how noisy a picture is.
#pragma once

#include "film/noise.h"

namespace chromeball {

struct PictureNoise {
  double noise, median, p95;  // fractions (film/noise.h)
  Image variance;             // of each pixel, RGB

  explicit PictureNoise(const PixelErrors& errors) {
    const std::vector<glm::dvec4> squared = squaredStandardErrors(errors);
    const NoiseQuantiles quantiles = noiseQuantiles(errors, squared);
    noise = estimateNoise(errors).noise;
    median = quantiles.median, p95 = quantiles.p95;
    variance = varianceImage(squared, errors.width, errors.height);
  }
};

}  // namespace chromeball
