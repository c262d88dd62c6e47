// SPDX-License-Identifier: Apache-2.0
// Hypothesis tests for means.
#pragma once

#include <cmath>
#include <span>

#include "image/image.h"

namespace chromeball {

// Mean and variance of independent repeats.
struct Moments {
  int count = 0;
  double mean = 0, variance = 0;  // unbiased sample variance

  static Moments of(std::span<const double> values);
};

// The probability that Student's t is at least as far from 0; 0 if `t` is not finite.
double twoSidedStudent(double t, double degreesOfFreedom);
// p-value of the hypothesis that both means are equal (Welch's t-test, two-sided).
double welchTest(const Moments& a, const Moments& b);

// The significance level of each of `tests` independent tests, if the probability that any of them
// rejects a true hypothesis is to be `significance` (Sidak 1967).
double sidak(double significance, int tests);

// An estimated number with its standard error.

struct Estimate {
  double mean = 0, standardError = 0;

  // The 95% confidence interval, for normal errors.
  double low() const { return mean - 1.96 * standardError; }
  double high() const { return mean + 1.96 * standardError; }
};

// The mean of independent numbers; its standard error is 0 for a single number.
Estimate meanOf(std::span<const double> numbers);

// An estimated ratio of positive numbers. Its error is one of the logarithm, so that its interval
// is above 0, and finite, however noisy the numbers are. The value is NaN if it is unknown.
struct RatioEstimate {
  double value = 0, logError = 0;

  // The 95% confidence interval, for normal errors of the logarithm.
  double low() const { return value * std::exp(-1.96 * logError); }
  double high() const { return value * std::exp(1.96 * logError); }
};

// The product of independent ratios.
RatioEstimate operator*(const RatioEstimate& a, const RatioEstimate& b);

// a / b of independent estimates; unknown unless both are above 0.
RatioEstimate ratio(const Estimate& a, const Estimate& b);

// The geometric mean of a[i] / b[i], with R - 1 degrees of freedom: the error is enlarged by
// Student's quantile, so that 1.96 of it are a 95% interval. All numbers are above 0.
RatioEstimate pairedRatio(std::span<const double> a, std::span<const double> b);

// Tests whether two unbiased ways of rendering give the same image.

// The result of Welch's t-tests on the mean luminance of every tile. If the images differ by noise
// only, `fraction` is 0 in 19 of 20 comparisons and pValue is uniform in [0, 1].
struct Agreement {
  static constexpr int kTile = 8;  // pixels per side; means over a tile are nearly normal

  Image z;  // one channel, one texel per tile: the normal deviate with the p-value of the test
  size_t tiles = 0;
  double fraction = 0;  // of tiles that differ, at a significance of 5% for all tests (Sidak)
  double pValue = 1;    // of the tile that differs most, corrected for the number of tiles (Sidak)
};

// `a` and `b`: each at least two RGB images; all images are independent and of one size.
Agreement agreement(std::span<const Image> a, std::span<const Image> b);

// Pearson's chi-square test of observed against expected counts. Cells with an expected count below
// `minimum` are pooled.
struct ChiSquare {
  double statistic = 0;
  int degreesOfFreedom = 0;
  double pValue = 1;  // chiSquarePValue()
};
ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected,
                        double minimum = 5);
// The probability of such a statistic if the distribution is as expected; 1 without a degree of
// freedom.
double chiSquarePValue(double statistic, int degreesOfFreedom);

}  // namespace chromeball
