// SPDX-License-Identifier: Apache-2.0
// The discrete cosine transform of 8 x 8 blocks, orthonormal, as in JPEG (ITU-T T.81, section
// A.3.3, whose factors are these).
#pragma once

#include <span>

namespace chromeball {

constexpr int kDctBlock = 8;

// Of a grid, row by row, in place: element (u, v) of each block becomes
//   sum over x, y of c(u) c(v) cos((2x + 1) u pi / 16) cos((2y + 1) v pi / 16) f(x, y),
// c(0) = sqrt(1/8), c = 1/2 otherwise. Both directions keep the sum of the squares. T: float,
// double or Rgb. Width and height: multiples of 8; otherwise throws std::invalid_argument.
template <class T>
void dctForward(std::span<T> grid, int width, int height);
template <class T>
void dctInverse(std::span<T> grid, int width, int height);

}  // namespace chromeball
