// SPDX-License-Identifier: Apache-2.0
// How far the pixels of a picture may be off, estimated from their samples.
#pragma once

#include <vector>

#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// The pixels' luminances, and two estimates of their squared standard errors: red, green, blue,
// luminance. In reading order; NaN where nothing is known (fewer than one sample in each half).
struct PixelErrors {
  int width = 0, height = 0;
  std::vector<double> luminances;
  // From the difference of the pixel's two independent halves: unbiased, one degree of freedom.
  std::vector<glm::dvec4> halves;
  // From the scatter of the samples, as if these were independent: precise, but too large, since
  // they are quasi-random.
  std::vector<glm::dvec4> scatter;

  // The errors become those of the sum or difference of two independent pictures.
  void add(const PixelErrors& other);
};

// One estimate of the two: a pixel's scatter, times the ratio of halves to scatter over those of
// the 7 x 7 pixels around it that scatter alike. Where few of these pixels have met most of the
// light (fireflies, caustics), the others will meet it too: each takes at least their mean. A pixel
// whose samples are all alike keeps 0: a composite where it is the plate, a black background.
std::vector<glm::dvec4> squaredStandardErrors(const PixelErrors& errors);

// Red, green and blue of such estimates as an image; NaN and infinities stay.
Image varianceImage(const std::vector<glm::dvec4>& squaredErrors, int width, int height);
inline Image varianceImage(const PixelErrors& errors) {
  return varianceImage(squaredStandardErrors(errors), errors.width, errors.height);
}

// Relative standard errors s / max(m, 0.01 M) of the pixels' luminances: s the standard error, m
// the luminance, M the picture's mean luminance. Pixels of which nothing is known do not count;
// NaN where nothing is known of any pixel, or all of them are black.
struct Noise {
  double noise;  // root of the mean square; its square is unbiased (from `halves`)
  double upper;  // end of the 95% interval of `noise`
};
Noise estimateNoise(const PixelErrors& errors);

struct NoiseQuantiles {
  double median, p95;  // over the pixels
};
NoiseQuantiles noiseQuantiles(const PixelErrors& errors,
                              const std::vector<glm::dvec4>& squaredErrors);

}  // namespace chromeball
