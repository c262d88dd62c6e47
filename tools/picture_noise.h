// The numbers that say how noisy a picture is.
#pragma once

#include "film/noise.h"

namespace chromeball {

struct PictureNoise {
  double noise, median, p95;  // fractions (film/noise.h)
  Image variance;             // of each pixel, RGB

  PictureNoise(const std::vector<double>& luminances, const PixelErrors& errors) {
    const std::vector<glm::dvec4> squared = squaredStandardErrors(errors);
    const NoiseQuantiles quantiles = noiseQuantiles(luminances, squared);
    noise = estimateNoise(luminances, errors).noise;
    median = quantiles.median, p95 = quantiles.p95;
    variance = varianceImage(squared, errors.width, errors.height);
  }
};

}  // namespace chromeball
