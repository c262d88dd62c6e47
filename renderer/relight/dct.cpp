// SPDX-License-Identifier: Apache-2.0
#include "relight/dct.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "math/vec.h"

namespace chromeball {
namespace {

constexpr size_t kSize = kDctBlock;
using Matrix = std::array<std::array<float, kSize>, kSize>;

Matrix transposed(const Matrix& m) {
  Matrix t;
  for (size_t i = 0; i < kSize; ++i)
    for (size_t k = 0; k < kSize; ++k) t[i][k] = m[k][i];
  return t;
}

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

template <class T>
void transform(std::span<T> grid, int width, int height, const Matrix& matrix) {
  if (width < 1 || height < 1 || width % kDctBlock != 0 || height % kDctBlock != 0 ||
      grid.size() != size_t(width) * size_t(height))
    throw std::invalid_argument("dct: width and height are not multiples of 8");
  const auto stride = size_t(width);
  for (size_t y = 0; y < size_t(height); ++y)
    for (size_t x = 0; x < stride; x += kSize) multiply(matrix, &grid[y * stride + x], 1);
  for (size_t y = 0; y < size_t(height); y += kSize)
    for (size_t x = 0; x < stride; ++x) multiply(matrix, &grid[y * stride + x], stride);
}

}  // namespace

template <class T>
void dctForward(std::span<T> grid, int width, int height) {
  transform(grid, width, height, cosines());
}

template <class T>
void dctInverse(std::span<T> grid, int width, int height) {
  transform(grid, width, height, transposed(cosines()));
}

template void dctForward(std::span<float>, int, int);
template void dctForward(std::span<double>, int, int);
template void dctForward(std::span<Rgb>, int, int);
template void dctInverse(std::span<float>, int, int);
template void dctInverse(std::span<double>, int, int);
template void dctInverse(std::span<Rgb>, int, int);

}  // namespace chromeball
