// SPDX-License-Identifier: Apache-2.0
// Invalid texels: counted, located, and replaced, so that nothing behind this point meets one.
#pragma once

#include <string>

#include "image/image.h"

namespace chromeball {

struct RepairReport {
  size_t nan = 0, infinite = 0, negative = 0;  // texels; each counts once, for its worst channel
  int firstX = -1, firstY = -1;                // the first in reading order; -1: none

  size_t total() const { return nan + infinite + negative; }
};

// Repairs the first three channels in place. A negative or -infinite channel becomes 0. A texel
// with a NaN becomes the mean of the valid ones among its eight neighbours (x wraps where `wrapX`),
// or black where there is none. A +infinite channel becomes the largest finite one of the image: it
// was the brightest thing in the picture, and averaging would lose it.
RepairReport repair(Image& image, bool wrapX);

// "3 NaN, 1 infinite, 20 negative texels, the first at (5, 7)".
std::string describe(const RepairReport& report);

}  // namespace chromeball
