// SPDX-License-Identifier: Apache-2.0
// Error estimates for the pixels of an image, from their samples.
#pragma once

#include <cstdint>
#include <vector>

#include "base/archive.h"
#include "image/image.h"
#include "math/vec.h"

namespace chromeball {

// The luminance of each pixel, and two estimates of its squared standard error (red, green, blue,
// luminance). In scanline order; NaN where a half has no samples.
struct PixelErrors {
  int width = 0, height = 0;
  std::vector<double> luminances;
  // Estimated from the difference of the pixel's two independent halves: unbiased, one degree of
  // freedom.
  std::vector<glm::dvec4> halves;
  // Estimated from the sample variance, as if the samples were independent: precise, but too large,
  // since they are quasi-random.
  std::vector<glm::dvec4> scatter;

  // Adds the squared errors of `other`, as for the sum or difference of two independent images.
  void add(const PixelErrors& other);
};

// Combines both estimates: the scatter of a pixel, times the weighted mean ratio of halves to
// scatter over the 7 x 7 window around it; pixels of similar scatter have the largest weights. If
// few pixels of the window hold most of the scatter (fireflies, caustics), their mean over the
// window is a lower bound, because the other pixels would meet the same rare light with more
// samples. A pixel whose samples are all equal keeps 0 (a plate without objects, a black
// background).
std::vector<glm::dvec4> squaredStandardErrors(const PixelErrors& errors);

// The red, green and blue components of such estimates as an image; NaN and infinities stay.
Image varianceImage(const std::vector<glm::dvec4>& squaredErrors, int width, int height);
inline Image varianceImage(const PixelErrors& errors) {
  return varianceImage(squaredStandardErrors(errors), errors.width, errors.height);
}

// Statistics of the pixels' relative standard errors s / max(m, 0.01 M): s the standard error, m
// the luminance, M the mean luminance of the image. Pixels without an estimate are left out. NaN if
// no pixel has an estimate or the image is black.
struct Noise {
  double noise;  // root mean square, from `halves`; its square is unbiased
  double upper;  // end of the 95% interval of `noise`
};
Noise estimateNoise(const PixelErrors& errors);

// The relative standard errors as an image of one channel, with s from `squaredErrors`; at most 1,
// since few samples may leave a pixel darker than its error. NaN for pixels without an estimate,
// and for all of a black image.
Image relativeErrors(const PixelErrors& errors, const std::vector<glm::dvec4>& squaredErrors);

// Over the pixels that have noise: not NaN, and above 0.2%, below which are plates, black
// backgrounds, lights seen directly and most of a visible probe; if none is above, over those that
// are not 0. NaN if all are NaN, 0 if none has noise.
struct NoiseQuantiles {
  double median, p95;
};
NoiseQuantiles noiseQuantiles(const Image& relativeErrors);

// How many samples each pixel takes: more where the image is noisier (adaptive sampling).

// Allots the samples that follow a pilot render with the same number of samples in every pixel. A
// pixel's number is proportional to the root of the relative variance of the pixels around it,
// which minimizes the sum of the relative variances of the means.
//
// The mean of a pixel remains unbiased, since its number of samples is independent of its own
// samples: its weight, the normalization of the weights and the exposure all exclude it.
class SampleAllocation {
 public:
  // An equal number of samples everywhere; to be read from an archive.
  SampleAllocation(int width, int height)
      : width_(width), rates_(size_t(width) * size_t(height), 1.0f) {}
  // `pilotSamples`: per pixel. `leastRate`: every pixel takes at least so many of the samples that
  // follow, relative to their mean number.
  SampleAllocation(const PixelErrors& pilot, uint32_t pilotSamples, float leastRate = 0);

  // Samples of the pixel when the image has `mean` samples per pixel, the pilot's included. Does
  // not decrease with `mean`; equals it up to the pilot's number.
  uint32_t count(int x, int y, uint32_t mean) const;

  void archive(Archive& a);

 private:
  size_t index(int x, int y) const { return size_t(y) * size_t(width_) + size_t(x); }

  int width_;
  uint32_t pilotSamples_ = 0;
  std::vector<float> rates_;  // samples of the pixel per mean sample, after the pilot
};

}  // namespace chromeball
