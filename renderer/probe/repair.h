// SPDX-License-Identifier: Apache-2.0
// Counts, locates and replaces invalid texels: NaN, infinite and negative ones.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball {

struct RepairReport {
  // Numbers of texels; each counts once: as NaN if any channel is, else as infinite, else negative.
  size_t nan = 0, infinite = 0, negative = 0;
  int firstX = -1, firstY = -1;  // the first in reading order; -1: none

  size_t total() const { return nan + infinite + negative; }
};

// Repairs the first three channels in place. A negative or -infinite channel becomes 0. A texel
// with a NaN becomes the mean of those among its eight neighbours that have none (x wraps if
// `wrapX`), or black if there are none. A +infinite channel becomes the largest finite channel of
// the image: it marks the brightest source, which an average of the neighbours would lose.
RepairReport repair(Image& image, bool wrapX);

// "3 NaN, 1 infinite, 20 negative texels, the first at (5, 7)".
std::string describe(const RepairReport& report);

}  // namespace chromeball
