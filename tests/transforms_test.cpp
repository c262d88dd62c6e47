// SPDX-License-Identifier: Apache-2.0
// The orthonormal transforms of relighting: Haar wavelets and 8 x 8 blocks of cosines.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "math/vec.h"
#include "relight/stage/transforms.h"
#include "sphere_test.h"

namespace chromeball::transforms_test {
namespace {

std::vector<double> randomGrid(size_t count, int seed) {
  std::vector<double> grid(count);
  for (size_t i = 0; i < count; ++i) grid[i] = random2(int(i), seed).x - 0.3;
  return grid;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

struct Transform {
  const char* name;
  int width, height;
  void (*forward)(std::vector<double>&, int, int);

  // The inverse of an orthonormal transform is its transpose.
  std::vector<double> inverse(const std::vector<double>& transformed) const {
    std::vector<double> grid;
    for (size_t i = 0; i < transformed.size(); ++i) {
      std::vector<double> column(transformed.size());
      column[i] = 1;
      forward(column, width, height);
      grid.push_back(dot(column, transformed));
    }
    return grid;
  }
  // The grid that becomes 1 at `i` and 0 elsewhere.
  std::vector<double> basisFunction(size_t i) const {
    std::vector<double> one(size_t(width) * size_t(height));
    one[i] = 1;
    return inverse(one);
  }
};

void haarTo(std::vector<double>& grid, int width, int) { haarForward(std::span(grid), width); }
void dctTo(std::vector<double>& grid, int w, int h) { dctForward(std::span(grid), w, h); }

const Transform kTransforms[] = {{"haar 1", 1, 1, haarTo},
                                 {"haar 2", 2, 2, haarTo},
                                 {"haar 32", 32, 32, haarTo},
                                 {"dct 8x8", 8, 8, dctTo},
                                 {"dct 32x16", 32, 16, dctTo}};

TEST(Transform, keepsScalarProductsAndIsUndoneByItsInverse) {
  for (const Transform& t : kTransforms) {
    SCOPED_TRACE(t.name);
    const auto count = size_t(t.width) * size_t(t.height);
    const std::vector<double> a = randomGrid(count, 1), b = randomGrid(count, 2);
    std::vector<double> ta = a, tb = b;
    t.forward(ta, t.width, t.height);
    t.forward(tb, t.width, t.height);
    EXPECT_NEAR(dot(ta, tb), dot(a, b), 1e-6 * double(count));
    EXPECT_NEAR(dot(ta, ta), dot(a, a), 1e-6 * double(count));
    const std::vector<double> back = t.inverse(ta);
    for (size_t i = 0; i < count; ++i) ASSERT_NEAR(back[i], a[i], 1e-6);
  }
}

// Haar's basis functions of a 4 x 4 grid, written out.
TEST(Haar, hasTheBasisFunctionsOfTheNonStandardDecomposition) {
  std::vector<double> grid(16, 1.0);
  haarForward(std::span(grid), 4);
  EXPECT_DOUBLE_EQ(grid[0], 4);  // the sum divided by the size
  for (size_t i = 1; i < 16; ++i) EXPECT_EQ(grid[i], 0);

  const Transform haar{"haar 4", 4, 4, haarTo};
  for (size_t y = 0; y < 4; ++y)
    for (size_t x = 0; x < 4; ++x) {
      const size_t i = 4 * y + x;
      EXPECT_DOUBLE_EQ(haar.basisFunction(1)[i], x < 2 ? 0.25 : -0.25);
      EXPECT_DOUBLE_EQ(haar.basisFunction(4)[i], y < 2 ? 0.25 : -0.25);
      EXPECT_DOUBLE_EQ(haar.basisFunction(5)[i], (x < 2) == (y < 2) ? 0.25 : -0.25);
      const double fine = x == 0 ? 0.5 : x == 1 ? -0.5 : 0;  // of the upper left block
      EXPECT_DOUBLE_EQ(haar.basisFunction(2)[i], y < 2 ? fine : 0);
    }
}

TEST(Dct, hasTheCosinesOfTheStandard) {
  const Transform dct{"dct 16x8", 16, 8, dctTo};
  for (int u = 0; u < 8; ++u)
    for (int v = 0; v < 8; ++v) {
      const std::vector<double> grid =
          dct.basisFunction(size_t(16 * v + 8 + u));  // of the second block
      const double c = (u ? 0.5 : std::sqrt(0.125)) * (v ? 0.5 : std::sqrt(0.125));
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
          ASSERT_EQ(grid[size_t(16 * y + x)], 0);
          ASSERT_NEAR(
              grid[size_t(16 * y + 8 + x)],
              c * std::cos((2 * x + 1) * u * kPiD / 16) * std::cos((2 * y + 1) * v * kPiD / 16),
              1e-7);
        }
    }
}

TEST(Transform, refusesOtherSizes) {
  std::vector<double> grid(36);
  EXPECT_THROW(haarForward(std::span(grid), 6), std::invalid_argument);
  EXPECT_THROW(haarForward(std::span(grid), 4), std::invalid_argument);
  EXPECT_THROW(dctForward(std::span(grid), 9, 4), std::invalid_argument);
  EXPECT_THROW(dctForward(std::span(grid), 8, 8), std::invalid_argument);
}

}  // namespace
}  // namespace chromeball::transforms_test
