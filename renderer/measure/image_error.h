// SPDX-License-Identifier: Apache-2.0
// Error metrics between two images.
#pragma once

#include <optional>

#include "image/image.h"

namespace chromeball {

// Statistics of z = (a - b) / sqrt(variance a + variance b) over all channels of positive variance.
// If the images differ by noise only, the mean is 0, the deviation 1, and 0.27% are beyond 3. Since
// the variances are estimates, a few more are far out than for normal deviates.
struct ZScores {
  size_t count = 0;
  double mean = 0, standardDeviation = 0, fractionBeyond3 = 0;
  double largest = 0;  // maximum |z|
  double pValue = 1;   // probability of such a maximum among normal deviates (Sidak)
};

// Errors over pixels and channels. Pairs with a number that is not finite are counted and ignored.
struct ImageError {
  double mse = 0;
  double relMse = 0;         // mean of (a - b)^2 / (b^2 + 0.01)
  double bias = 0;           // mean(a - b) / mean(b); infinite or NaN where mean(b) is 0
  double maxDifference = 0;  // maximum |a - b|
  double psnr = 0;           // dB relative to the maximum |b|; infinite if the images are equal
  size_t invalid = 0;
  std::optional<ZScores> zScores;
};

// `b` is the reference image. The variances are squared standard errors of the pixels, in the shape
// of the images; null if unknown, which counts as 0 (z-scores need at least one). Throws InputError
// if sizes or channels differ, or if no pair of numbers is finite.
ImageError imageError(const Image& a, const Image& b, const Image* varianceA = nullptr,
                      const Image* varianceB = nullptr);

// The maximum |z| of each pixel's channels, one channel; 0 where the variance is unknown.
Image zScoreImage(const Image& a, const Image& b, const Image* varianceA, const Image* varianceB);

// A map with one channel: for each pixel, the root of the mean over channels of (a - b)^2 / (b^2 +
// 0.01).
Image relativeErrorImage(const Image& a, const Image& b);

// The errors of images under estimated light, as papers on light estimation define them.

struct EstimateError {
  double rmse = 0;   // the root of the mean of (predicted - true)^2 over pixels and channels
  double scale = 1;  // sum(predicted true) / sum(predicted^2): the best factor on the predicted
  // RMSE of scale x predicted: blind to the exposure, not to colour (Grosse et al. 2009, "Ground
  // truth dataset and baseline evaluations for intrinsic image algorithms", section 4).
  double scaleInvariantRmse = 0;
  // The mean angle between the colours of a pixel as vectors of R, G and B, in degrees: blind to
  // brightness (LeGendre et al. 2019). Over the pixels that are black in neither image; NaN if
  // there are none.
  double angularError = 0;
};

// Over the pixels where `mask` (one channel) is not 0: at least one. All images are of one size.
EstimateError estimateError(const Image& predicted, const Image& truth, const Image& mask);

// FLIP: the difference that people perceive when alternating between two images (Andersson et al.
// 2020, "FLIP: A Difference Evaluator for Alternating Images"; for HDR, Andersson et al. 2021).

// Pixels per degree of a screen that is 3840 pixels and 0.7 m wide, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

// The difference of each pixel, one channel, from 0 (equal) to 1. Both images are RGB, of one size
// and display-linear in [0, 1]; numbers outside are clamped. Throws InputError if sizes differ.
Image flip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

// The maximum of the differences at several exposures, for images of radiance. The exposures range,
// about a stop apart, from the one that maps the reference's maximum luminance to 0.85 of the
// screen's white to the one that maps its median luminance to 0.85. The tone mapper is Narkowicz's
// fit of ACES.
Image hdrFlip(const Image& reference, const Image& test, double pixelsPerDegree = kPixelsPerDegree);

}  // namespace chromeball
