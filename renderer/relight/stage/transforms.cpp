// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/transforms.h"

#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "math/vec.h"

namespace chromeball {
namespace {

void check(size_t elements, int size) {
  if (size < 1 || !std::has_single_bit(unsigned(size)) || elements != size_t(size) * size_t(size))
    throw std::invalid_argument("haar: the grid is not square with a power of two as its size");
}

// The matrix of a block is symmetric and orthogonal: it is its own inverse.
template <class T>
struct Block {
  T a, b, c, d;

  Block transformed() const {
    return {(a + b + c + d) * 0.5f, (a - b + c - d) * 0.5f, (a + b - c - d) * 0.5f,
            (a - b - c + d) * 0.5f};
  }
};

// One level, between the pixels of the upper left `size` x `size` elements of the grid, whose rows
// have `stride` elements, and their four quadrants.
template <class T>
class Level {
 public:
  Level(std::span<T> grid, size_t stride, size_t size, std::vector<T>& scratch)
      : grid_(grid), stride_(stride), half_(size / 2), scratch_(scratch) {}

  void split() {
    transform([&](size_t x, size_t y) { return block(2 * x, 2 * y, 1); },
              [&](size_t x, size_t y) { return place(x, y, half_); });
  }
  void join() {
    transform([&](size_t x, size_t y) { return block(x, y, half_); },
              [&](size_t x, size_t y) { return place(2 * x, 2 * y, 1); });
  }

 private:
  struct Place {
    size_t first, right, below, diagonal;
  };
  Place place(size_t x, size_t y, size_t step) const {
    const size_t first = y * stride_ + x;
    return {first, first + step, first + step * stride_, first + step * (stride_ + 1)};
  }
  Block<T> block(size_t x, size_t y, size_t step) const {
    const Place p = place(x, y, step);
    return {grid_[p.first], grid_[p.right], grid_[p.below], grid_[p.diagonal]};
  }

  template <class From, class To>
  void transform(const From& from, const To& to) {
    scratch_.resize(grid_.size());
    for (size_t y = 0; y < half_; ++y)
      for (size_t x = 0; x < half_; ++x) {
        const Block<T> result = from(x, y).transformed();
        const Place p = to(x, y);
        scratch_[p.first] = result.a, scratch_[p.right] = result.b;
        scratch_[p.below] = result.c, scratch_[p.diagonal] = result.d;
      }
    for (size_t y = 0; y < 2 * half_; ++y)
      for (size_t x = 0; x < 2 * half_; ++x) grid_[y * stride_ + x] = scratch_[y * stride_ + x];
  }

  std::span<T> grid_;
  size_t stride_, half_;
  std::vector<T>& scratch_;
};

}  // namespace

template <class T>
void haarForward(std::span<T> grid, int size) {
  check(grid.size(), size);
  std::vector<T> scratch;
  for (auto s = size_t(size); s > 1; s /= 2) Level<T>(grid, size_t(size), s, scratch).split();
}

template <class T>
void haarInverse(std::span<T> grid, int size) {
  check(grid.size(), size);
  std::vector<T> scratch;
  for (size_t s = 2; s <= size_t(size); s *= 2) Level<T>(grid, size_t(size), s, scratch).join();
}

template void haarForward(std::span<float>, int);
template void haarForward(std::span<double>, int);
template void haarForward(std::span<Rgb>, int);
template void haarInverse(std::span<float>, int);
template void haarInverse(std::span<double>, int);
template void haarInverse(std::span<Rgb>, int);

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
