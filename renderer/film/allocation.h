// SPDX-License-Identifier: Apache-2.0
// How many samples each pixel takes: more where the image is noisier (adaptive sampling).
#pragma once

#include <cstdint>
#include <vector>

#include "base/archive.h"
#include "film/noise.h"

namespace chromeball {

// Allots the samples that follow a pilot render with the same number of samples in every pixel. A
// pixel's number is proportional to the root of the relative variance of the pixels around it,
// which minimizes the sum of the relative variances of the means.
//
// The mean of a pixel remains unbiased, since its number of samples is independent of its own
// samples: its weight, the normalization of the weights and the exposure all exclude it.
class SampleAllocation {
 public:
  // As many samples everywhere; to be read from an archive.
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
