// SPDX-License-Identifier: Apache-2.0
// Tests whether two unbiased ways of rendering give the same image.
#pragma once

#include <span>

#include "image/image.h"

namespace chromeball {

// The result of Welch's t-tests on the mean luminance of every tile. If the images differ by noise
// only, `fraction` is 0 in 19 of 20 comparisons and pValue is uniform in [0, 1].
struct Agreement {
  static constexpr int kTile = 8;  // pixels per side; means over a tile are nearly normal

  Image z;  // one channel, one texel per tile: the normal deviate with the p-value of the test
  size_t tiles = 0;
  double fraction = 0;  // of tiles that differ, at a significance of 5% for all tests (Sidak)
  double pValue = 1;    // of the tile that differs most, corrected for the number of tiles (Sidak)
};

// `a` and `b`: each at least two RGB images; all images are independent and of one size.
Agreement agreement(std::span<const Image> a, std::span<const Image> b);

}  // namespace chromeball
