// SPDX-License-Identifier: Apache-2.0
// Stratification of the Sobol table, and independence of its numbers.
#include <gtest/gtest.h>

#include <set>

#include "math/sampler.h"
#include "sphere_test.h"

namespace chromeball::sampler_test {
namespace {

// Whether each of the 2^k elementary intervals of every shape 2^-a x 2^-(k-a) contains exactly one
// of the pixel's 2^k points first, first + 1, ..., in dimensions d and d + 1.
bool isNet(const PixelSampler& prototype, uint32_t first, int k, int d) {
  PixelSampler sampler = prototype;
  for (int a = 0; a <= k; ++a) {
    std::set<uint32_t> boxes;
    for (uint32_t i = 0; i < (1u << k); ++i) {
      sampler.startSample(first + i);
      const uint32_t x = a ? sampler.bits(d) >> (32 - a) : 0;
      const uint32_t y = a < k ? sampler.bits(d + 1) >> (32 - (k - a)) : 0;
      boxes.insert(x << (k - a) | y);
    }
    if (boxes.size() != (1u << k)) return false;
  }
  return true;
}

TEST(Sampler, everyPowerOfTwoOfSamplesIsANet) {
  const SobolTable table(256, 20, 7);
  PixelSampler sampler(table, 7);
  sampler.startPixel(12, 34, 0);
  for (int d : {0, 4, 8, 12, 16})
    for (int k = 0; k <= 8; ++k) {
      EXPECT_TRUE(isNet(sampler, 0, k, d)) << "dimension " << d << ", 2^" << k;
      if (k < 8) {
        EXPECT_TRUE(isNet(sampler, 1u << k, k, d)) << "second half, 2^" << k;
      }
    }
}

TEST(Sampler, dependsOnPixelSampleDimensionAndSeedOnly) {
  const SobolTable table(64, 12, 3), other(64, 12, 4);
  PixelSampler a(table, 3), b(table, 3), c(other, 4);
  b.startPixel(9, 9, 2);
  b.startSample(5);
  a.startPixel(1, 2, 0);
  b.startPixel(1, 2, 0);
  c.startPixel(1, 2, 0);
  std::set<uint32_t> seen;
  for (uint32_t i = 0; i < 64; ++i) {
    a.startSample(i);
    b.startSample(i);
    c.startSample(i);
    for (int d = 0; d < 40; ++d) {  // beyond the table: independent random numbers
      ASSERT_EQ(a.bits(d), b.bits(d));
      ASSERT_NE(a.bits(d), c.bits(d));
      seen.insert(a.bits(d));
    }
  }
  EXPECT_GT(seen.size(), 64u * 40 - 5);
}

TEST(Sampler, blocksAndPixelsAreIndependent) {
  const SobolTable table(16, 8, 1);
  PixelSampler sampler(table, 1);
  // Correlation of the mean of 16 numbers between neighbours and between blocks.
  const auto mean = [&](uint32_t x, uint32_t y, uint64_t block) {
    sampler.startPixel(x, y, block);
    double sum = 0;
    for (uint32_t i = 0; i < 16; ++i) {
      sampler.startSample(i);
      sum += double(sampler.get1(0)) * double(sampler.get1(5));
    }
    return sum / 16;
  };
  double xy = 0, xb = 0, xx = 0;
  constexpr int kPixels = 20000;
  for (uint32_t i = 0; i < kPixels; ++i) {
    const double here = mean(i, 0, 0) - 0.25;
    xy += here * (mean(i, 1, 0) - 0.25);
    xb += here * (mean(i, 0, 1) - 0.25);
    xx += here * here;
  }
  EXPECT_LT(std::fabs(xy / xx), 4 / std::sqrt(kPixels));
  EXPECT_LT(std::fabs(xb / xx), 4 / std::sqrt(kPixels));
}

TEST(Sampler, eachNumberIsUniform) {
  const SobolTable table(4, 8, 5);
  PixelSampler sampler(table, 5);
  for (int d : {0, 3, 7, 30}) {
    std::vector<double> counts(64), expected(64, 4 * 5000 / 64.0);
    for (uint32_t pixel = 0; pixel < 5000; ++pixel) {
      sampler.startPixel(pixel, 77, 0);
      for (uint32_t i = 0; i < 4; ++i) {
        sampler.startSample(i);
        ++counts[int(sampler.get1(d) * 64)];
      }
    }
    EXPECT_GT(chiSquareTest(counts, expected).pValue, 1e-4) << d;
  }
}

}  // namespace
}  // namespace chromeball::sampler_test
