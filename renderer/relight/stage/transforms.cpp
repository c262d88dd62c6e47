// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/transforms.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "math/vec.h"

namespace chromeball {
template <class T>
void haarForward(std::span<T> grid, int size) {
  const auto stride = size_t(std::max(size, 0));
  if (!std::has_single_bit(stride) || grid.size() != stride * stride)
    throw std::invalid_argument("haar: the grid is not square with a power of two as its size");
  std::vector<T> level(grid.size());
  for (size_t half = stride / 2; half > 0; half /= 2) {
    for (size_t y = 0; y < half; ++y)
      for (size_t x = 0; x < half; ++x) {
        const T *upper = &grid[2 * y * stride + 2 * x], *lower = upper + stride;
        const T a = upper[0], b = upper[1], c = lower[0], d = lower[1];
        T* low = &level[y * stride + x];
        low[0] = (a + b + c + d) * 0.5f;
        low[half] = (a - b + c - d) * 0.5f;
        low[half * stride] = (a + b - c - d) * 0.5f;
        low[half * (stride + 1)] = (a - b - c + d) * 0.5f;
      }
    for (size_t y = 0; y < 2 * half; ++y)
      std::copy_n(&level[y * stride], 2 * half, &grid[y * stride]);
  }
}

template void haarForward(std::span<double>, int);
template void haarForward(std::span<Rgb>, int);

namespace {

constexpr size_t kSize = kDctBlock;
using Matrix = std::array<std::array<float, kSize>, kSize>;

// [frequency][position]
const Matrix& cosines() {
  static const Matrix matrix = [] {
    Matrix m;
    for (size_t u = 0; u < kSize; ++u)
      for (size_t x = 0; x < kSize; ++x)
        m[u][x] = float((u == 0 ? std::sqrt(0.125) : 0.5) *
                        std::cos(double(2 * x + 1) * double(u) * kPiD / 16));
    return m;
  }();
  return matrix;
}

// Eight elements, `step` apart, become matrix times them.
template <class T>
void multiply(const Matrix& matrix, T* line, size_t step) {
  std::array<T, kSize> result;
  for (size_t u = 0; u < kSize; ++u) {
    result[u] = T(0);
    for (size_t x = 0; x < kSize; ++x) result[u] += line[x * step] * matrix[u][x];
  }
  for (size_t u = 0; u < kSize; ++u) line[u * step] = result[u];
}

}  // namespace

template <class T>
void dctForward(std::span<T> grid, int width, int height) {
  if (width < 1 || height < 1 || width % kDctBlock != 0 || height % kDctBlock != 0 ||
      grid.size() != size_t(width) * size_t(height))
    throw std::invalid_argument("dct: width and height are not multiples of 8");
  const auto stride = size_t(width);
  for (size_t y = 0; y < size_t(height); ++y)
    for (size_t x = 0; x < stride; x += kSize) multiply(cosines(), &grid[y * stride + x], 1);
  for (size_t y = 0; y < size_t(height); y += kSize)
    for (size_t x = 0; x < stride; ++x) multiply(cosines(), &grid[y * stride + x], stride);
}

template void dctForward(std::span<double>, int, int);
template void dctForward(std::span<Rgb>, int, int);

}  // namespace chromeball
