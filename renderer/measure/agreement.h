// SPDX-License-Identifier: Apache-2.0
// Do two unbiased ways of rendering give the same picture?
#pragma once

#include <span>

#include "image/image.h"

namespace chromeball {

// Of Welch's t-tests on the mean luminance of every tile. Where both pictures are the same but for
// noise, `fraction` is 0 in 19 of 20 comparisons, and pValue is uniform in [0, 1].
struct Agreement {
  static constexpr int kTile = 8;  // pixels a side; over a tile, errors are nearly normal

  Image z;  // one channel, one texel a tile: the normal deviate as improbable as the test
  size_t tiles = 0;
  double fraction = 0;  // of tiles that differ at 5% for all tests together (Sidak)
  double pValue = 1;    // of the tile that differs most, for as many tests (Sidak)
};

// Both: two or more independent RGB images of one size, and independent of the others.
Agreement agreement(std::span<const Image> a, std::span<const Image> b);

}  // namespace chromeball
