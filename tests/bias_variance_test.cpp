// SPDX-License-Identifier: Apache-2.0
// Estimates of error, variance and bias from synthetic images with known noise and bias; power-law
// fits; agreement tests of images.
#include "measure/bias_variance.h"

#include <gtest/gtest.h>

#include <random>

#include "measure/statistics.h"

namespace chromeball::bias_variance_test {
namespace {

constexpr int kWidth = 24, kHeight = 16;

// Images with pixel means of 0.8 to 1.6, a noise level that varies over the image, and a bias.
struct World {
  Image expectation{kWidth, kHeight, 3}, sigma{kWidth, kHeight, 3}, bias{kWidth, kHeight, 3};
  std::mt19937_64 random;

  explicit World(uint64_t seed, float biasScale) : random(seed) {
    std::uniform_real_distribution<float> unit;
    for (size_t i = 0; i < expectation.texels.size(); ++i) {
      expectation.texels[i] = 0.8f + 0.8f * unit(random);
      sigma.texels[i] = 0.02f + 0.1f * unit(random);
      bias.texels[i] = biasScale * (unit(random) - 0.3f);
    }
  }

  Image render(float noise, bool biased) {
    std::normal_distribution<float> normal;
    Image image = expectation;
    for (size_t i = 0; i < expectation.texels.size(); ++i)
      image.texels[i] += noise * sigma.texels[i] * normal(random) + biased * bias.texels[i];
    return image;
  }
  // Noise that is the same in blocks of 8 x 8 pixels.
  Image renderInBlocks() {
    std::normal_distribution<float> normal;
    const auto blocks = size_t(kWidth / 8 * kHeight / 8);
    std::vector<float> deviates(blocks);
    for (float& d : deviates) d = normal(random);
    Image image = expectation;
    for (size_t i = 0; i < image.texels.size(); ++i) {
      const size_t x = i / 3 % kWidth, y = i / 3 / kWidth;
      image.texels[i] += sigma.texels[i] * deviates[y / 8 * (kWidth / 8) + x / 8] + bias.texels[i];
    }
    return image;
  }
  std::vector<Image> repeats(int count, float noise) {
    std::vector<Image> images;
    for (int i = 0; i < count; ++i) images.push_back(render(noise, true));
    return images;
  }
  Reference reference(float noise) {
    Reference reference{render(noise, false), sigma};
    for (float& v : reference.squaredError.texels) v *= v * noise * noise;
    return reference;
  }

  struct Expected {
    double variance = 0, squaredBias = 0, bias = 0;
  };
  Expected expected(float noise) const {
    Expected result;
    double sum = 0;
    const double n = double(expectation.texels.size());
    for (size_t i = 0; i < expectation.texels.size(); ++i) {
      const double t = expectation.texels[i], s = noise * sigma.texels[i], b = bias.texels[i];
      result.variance += s * s / (t * t + 0.01) / n;
      result.squaredBias += b * b / (t * t + 0.01) / n;
      result.bias += b;
      sum += t;
    }
    result.bias /= sum;
    return result;
  }
};

// The 95% intervals contain the true value in at least 93% of the studies, and at most in the
// fraction `maximum`, so that they are not too wide.
void expectCovers(int covered, int studies, const char* what, double maximum = 1) {
  const double fraction = double(covered) / studies;
  EXPECT_GE(fraction, 0.93) << what;
  EXPECT_LE(fraction, maximum) << what;
}

bool holds(const Estimate& e, double truth) { return e.low() <= truth && truth <= e.high(); }

// The studies whose intervals contain the true values.
struct Covered {
  int relMse = 0, variance = 0, squaredBias = 0, bias = 0;

  void add(const BiasVariance& error, const World::Expected& exact) {
    relMse += holds(error.relMse, exact.variance + exact.squaredBias);
    variance += holds(error.variance, exact.variance);
    squaredBias += holds(error.squaredBias, exact.squaredBias);
    bias += holds(error.bias, exact.bias);
  }
};

TEST(BiasVariance, intervalsContainTheTrueValues) {
  constexpr int kStudies = 500;
  for (const float biasScale : {0.0f, 0.05f, 0.5f}) {
    SCOPED_TRACE(biasScale);
    World world(7, biasScale);
    const World::Expected exact = world.expected(1);
    Covered covered;
    for (int study = 0; study < kStudies; ++study) {
      const BiasVariance error = biasVariance(world.repeats(4, 1), world.reference(0.2f));
      covered.add(error, exact);
    }
    expectCovers(covered.relMse, kStudies, "relMse");
    expectCovers(covered.variance, kStudies, "variance");
    expectCovers(covered.squaredBias, kStudies, "squared bias");
    expectCovers(covered.bias, kStudies, "bias");
  }
}

TEST(BiasVariance, intervalsContainTheTrueValuesIfPixelsAreJoined) {
  constexpr int kStudies = 500;
  for (const size_t count : {3u, 6u}) {
    SCOPED_TRACE(count);
    World world(23, 0.3f);
    const World::Expected exact = world.expected(1);
    Covered covered;
    for (int study = 0; study < kStudies; ++study) {
      std::vector<Image> repeats;
      while (repeats.size() < count) repeats.push_back(world.renderInBlocks());
      const BiasVariance error = biasVariance(repeats, world.reference(0.2f), PixelNoise::Joined);
      covered.add(error, exact);
    }
    expectCovers(covered.relMse, kStudies, "relMse");
    // The variance's estimate is skewed, as every one from few repeats is.
    EXPECT_GE(covered.variance, 0.85 * kStudies);
    expectCovers(covered.squaredBias, kStudies, "squared bias");
    expectCovers(covered.bias, kStudies, "bias");
  }
}

// Budgets that share a noisy reference share its error.
TEST(BiasVariance, theReferencesErrorRemainsInTheBiasOfAllBudgets) {
  constexpr int kStudies = 500;
  World world(29, 0.1f);
  const double exact = world.expected(1).squaredBias;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    const Reference reference = world.reference(0.3f);
    std::vector<BiasVariance> errors;
    for (int budget = 0; budget < 6; ++budget)
      errors.push_back(biasVariance(world.repeats(4, 0.4f), reference));
    const Estimate bias = commonSquaredBias(errors);
    covered += holds(bias, exact);
  }
  expectCovers(covered, kStudies, "squared bias", 0.99);
}

// The noise of the reference counts as error unless its variance is known.
TEST(BiasVariance, referenceVarianceIsRemoved) {
  World world(11, 0);
  const double expected = world.expected(1).variance;
  double with = 0, without = 0;
  constexpr int kStudies = 200;
  for (int study = 0; study < kStudies; ++study) {
    Reference reference = world.reference(0.5f);
    const std::vector<Image> repeats = world.repeats(3, 1);
    with += biasVariance(repeats, reference).relMse.mean / kStudies;
    reference.squaredError = {};
    without += biasVariance(repeats, reference).relMse.mean / kStudies;
  }
  EXPECT_NEAR(with / expected, 1, 0.02);
  EXPECT_NEAR(without / expected, 1.25, 0.02);
}

TEST(BiasVariance, partsAddUp) {
  World world(3, 0.3f);
  const BiasVariance error = biasVariance(world.repeats(5, 1), world.reference(0.3f));
  EXPECT_NEAR(error.relMse.mean, error.variance.mean + error.squaredBias.mean, 1e-12);
}

TEST(PowerLaw, isRecovered) {
  std::vector<ConvergencePoint> points;
  for (const double n : {1.0, 4.0, 16.0, 64.0})
    points.push_back({n, {3 * std::pow(n, -1.4), 0.1 * std::pow(n, -1.4)}});
  const PowerLaw law = fitPowerLaw(points).value();
  EXPECT_NEAR(law.slope.mean, -1.4, 1e-12);
  EXPECT_NEAR(std::exp(law.logAt(9)), 3 * std::pow(9, -1.4), 1e-12);
  points.resize(1);
  EXPECT_FALSE(fitPowerLaw(points));
}

TEST(PowerLaw, intervalContainsTheTrueExponent) {
  constexpr int kStudies = 2000;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  int covered = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<ConvergencePoint> points;
    for (const double n : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      const double exact = 5 / n, error = 0.03 * exact;
      points.push_back({n, {exact + error * normal(random), error}});
    }
    const Estimate slope = fitPowerLaw(points)->slope;
    covered += slope.low() <= -1 && -1 <= slope.high();
  }
  expectCovers(covered, kStudies, "slope");
}

TEST(PowerLaw, biasEqualsNoiseAtTheCrossing) {
  std::vector<ConvergencePoint> points;
  for (const double n : {1.0, 4.0, 16.0}) points.push_back({n, {2 / n, 0.02 / n}});
  const PowerLaw law = fitPowerLaw(points).value();
  const Crossing crossing = biasEqualsNoise(law, {0.004, 0.0004}).value();
  EXPECT_NEAR(crossing.samples, 500, 1e-6);
  EXPECT_LT(crossing.low, 500 * 0.85);
  EXPECT_GT(crossing.high, 500 * 1.15);
  EXPECT_FALSE(biasEqualsNoise(law, {0.004, 0.003})) << "a bias whose interval includes 0";
}

TEST(Agreement, pValuesAreUniformForEqualImages) {
  World world(13, 0);
  constexpr int kStudies = 2000;
  int below5 = 0, failing = 0;
  for (int study = 0; study < kStudies; ++study) {
    const Agreement result = agreement(world.repeats(4, 1), world.repeats(4, 1));
    below5 += result.pValue < 0.05;
    failing += result.fraction > 0;
  }
  // Welch's approximation is conservative with so few repeats.
  expectCovers(kStudies - below5, kStudies, "p-value");
  EXPECT_EQ(failing, below5) << "a tile fails iff the overall p-value is below 5%";
  EXPECT_GT(below5, kStudies / 100);
}

TEST(Agreement, differentImagesAreDetected) {
  World world(17, 0);
  std::vector<Image> a = world.repeats(4, 1), b = world.repeats(4, 1);
  for (Image& image : b)
    for (int y = 8; y < 16; ++y)
      for (int x = 0; x < 8; ++x) image.setRgb(x, y, image.rgb(x, y) + Rgb(0.2f));
  const Agreement result = agreement(a, b);
  EXPECT_EQ(result.tiles, 6u);
  EXPECT_LT(result.pValue, 0.01);
  EXPECT_NEAR(result.fraction, 1.0 / 6, 1e-9);
  EXPECT_LT(*result.z.at(0, 1), -3);
  EXPECT_LT(std::fabs(*result.z.at(2, 0)), 4);
}

}  // namespace
}  // namespace chromeball::bias_variance_test
