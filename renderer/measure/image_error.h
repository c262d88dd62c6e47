// SPDX-License-Identifier: Apache-2.0
// How far one image is from another.
#pragma once

#include <optional>

#include "image/image.h"

namespace chromeball {

// Of z = (a - b) / sqrt(variance a + variance b), over numbers whose variance is positive. Where
// the images agree but for noise: mean 0, deviation 1, and 0.27% beyond 3. Variances are estimates,
// so that a few pixels lie farther out than normal deviates would.
struct ZScores {
  size_t count = 0;
  double mean = 0, standardDeviation = 0, fractionBeyond3 = 0;
  double largest = 0;  // |z|
  double pValue = 1;   // chance of one as large among so many (Sidak), were they normal
};

// Over pixels and channels; pairs in which a number is not finite are counted and left out.
struct ImageError {
  double mse = 0;
  double relMse = 0;         // mean of (a - b)^2 / (b^2 + 0.01)
  double bias = 0;           // mean(a - b) / mean(b); infinite or NaN where mean(b) is 0
  double maxDifference = 0;  // largest |a - b|
  double psnr = 0;           // dB below the largest |b|; infinite where the images are equal
  size_t invalid = 0;
  std::optional<ZScores> zScores;
};

// `b` is the reference. Variances are squared standard errors of the pixels, of the images' sizes;
// null where unknown, which counts as 0 (z-scores need at least one). Throws InputError where sizes
// or channels differ.
ImageError imageError(const Image& a, const Image& b, const Image* varianceA = nullptr,
                      const Image* varianceB = nullptr);

// |z| of every pixel: the largest of its channels, one channel; 0 where no variance is known.
Image zScoreImage(const Image& a, const Image& b, const Image* varianceA, const Image* varianceB);

// Per pixel: the root of the mean over channels of (a - b)^2 / (b^2 + 0.01), one channel.
Image relativeErrorImage(const Image& a, const Image& b);

}  // namespace chromeball
