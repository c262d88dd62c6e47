// SPDX-License-Identifier: Apache-2.0
#include "measure/image_error.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"

namespace chromeball::image_error_test {
namespace {

Image filled(int w, int h, float number) {
  Image image(w, h, 3);
  std::fill(image.texels.begin(), image.texels.end(), number);
  return image;
}

TEST(ImageError, ClosedForms) {
  const ImageError error = imageError(filled(5, 4, 1.5f), filled(5, 4, 1));
  EXPECT_NEAR(error.mse, 0.25, 1e-12);
  EXPECT_NEAR(error.relMse, 0.25 / 1.01, 1e-12);
  EXPECT_NEAR(error.bias, 0.5, 1e-12);
  EXPECT_NEAR(error.maxDifference, 0.5, 1e-12);
  EXPECT_NEAR(error.psnr, 10 * std::log10(4.0), 1e-9);
  EXPECT_FALSE(error.zScores);

  Image a = filled(2, 1, 1);
  a.at(1, 0)[2] = 4;
  EXPECT_NEAR(imageError(a, filled(2, 1, 1)).mse, 9.0 / 6, 1e-12);
  EXPECT_NEAR(imageError(a, filled(2, 1, 1)).maxDifference, 3, 1e-12);
}

TEST(ImageError, EqualImages) {
  const ImageError error = imageError(filled(3, 3, 2), filled(3, 3, 2));
  EXPECT_EQ(error.mse, 0);
  EXPECT_EQ(error.bias, 0);
  EXPECT_TRUE(std::isinf(error.psnr));
  EXPECT_EQ(imageError(filled(3, 3, 0), filled(3, 3, 0)).bias, 0);
}

TEST(ImageError, InvalidNumbersAreCountedAndIgnored) {
  Image a = filled(2, 2, 1.5f);
  a.at(0, 0)[0] = std::nanf("");
  a.at(1, 1)[1] = std::numeric_limits<float>::infinity();
  const ImageError error = imageError(a, filled(2, 2, 1));
  EXPECT_EQ(error.invalid, 2u);
  EXPECT_NEAR(error.mse, 0.25, 1e-12);
  EXPECT_THROW(imageError(filled(2, 2, std::nanf("")), filled(2, 2, 1)), InputError);  // not 0
}

TEST(ImageError, SizesMustAgree) {
  EXPECT_THROW(imageError(filled(2, 3, 1), filled(3, 2, 1)), InputError);
  const Image variance = filled(1, 1, 1);
  EXPECT_THROW(imageError(filled(2, 3, 1), filled(2, 3, 1), &variance), InputError);
}

TEST(ImageError, ZScoresOfNormalNoise) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  Image a(200, 100, 3), b(200, 100, 3), varianceA(200, 100, 3), varianceB(200, 100, 3);
  for (size_t i = 0; i < a.texels.size(); ++i) {
    const float sigmaA = 0.01f * float(1 + i % 7), sigmaB = 0.02f;
    a.texels[i] = 1 + sigmaA * normal(random);
    b.texels[i] = 1 + sigmaB * normal(random);
    varianceA.texels[i] = sigmaA * sigmaA;
    varianceB.texels[i] = sigmaB * sigmaB;
  }
  const auto z = imageError(a, b, &varianceA, &varianceB).zScores;
  ASSERT_TRUE(z);
  EXPECT_EQ(z->count, 60000u);
  EXPECT_NEAR(z->mean, 0, 4 / std::sqrt(60000.0));
  EXPECT_NEAR(z->standardDeviation, 1, 4 / std::sqrt(2 * 60000.0));
  EXPECT_NEAR(z->fractionBeyond3, 0.0027, 0.001);

  // With only one of the variances, the scores have a larger variance. A shift of one sigma is
  // detected.
  EXPECT_GT(imageError(a, b, nullptr, &varianceB).zScores->standardDeviation, 1.5);
  for (size_t i = 0; i < a.texels.size(); ++i)
    a.texels[i] += std::sqrt(varianceA.texels[i] + varianceB.texels[i]);
  EXPECT_NEAR(imageError(a, b, &varianceA, &varianceB).zScores->mean, 1, 0.02);
}

}  // namespace
}  // namespace chromeball::image_error_test
