// SPDX-License-Identifier: Apache-2.0
// Orthonormal transforms in two dimensions: cosines, and Haar wavelets (Ng, Ramamoorthi and
// Hanrahan 2003: "All-Frequency Shadows Using Non-linear Wavelet Lighting Approximation", section
// 4).
#pragma once

#include <span>

namespace chromeball {

// The non-standard decomposition of a square grid, row by row, in place: each level replaces every
// 2 x 2 block a b / c d of what remains by
//   (a + b + c + d) / 2   in the low quadrant,        (a - b + c - d) / 2   to its right,
//   (a + b - c - d) / 2   below,                      (a - b - c + d) / 2   diagonally.
// So element 0 becomes the sum divided by `size`. It keeps the sum of the squares. T: double or
// Rgb. `size`: a power of two; `grid` has size^2 elements. Otherwise throws std::invalid_argument.
template <class T>
void haarForward(std::span<T> grid, int size);

constexpr int kDctBlock = 8;

// The discrete cosine transform of 8 x 8 blocks of a grid, orthonormal, as in JPEG (ITU-T T.81,
// section A.3.3, with the same factors), row by row, in place: element (u, v) of each block becomes
//   sum over x, y of c(u) c(v) cos((2x + 1) u pi / 16) cos((2y + 1) v pi / 16) f(x, y),
// c(0) = sqrt(1/8), c = 1/2 otherwise. It keeps the sum of the squares. T: double or Rgb. Width and
// height: multiples of 8; otherwise throws std::invalid_argument.
template <class T>
void dctForward(std::span<T> grid, int width, int height);

}  // namespace chromeball
