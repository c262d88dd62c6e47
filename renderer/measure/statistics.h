// SPDX-License-Identifier: Apache-2.0
// Hypothesis tests: is this the distribution, is this the same number?
#pragma once

#include <span>

namespace chromeball {

// Pearson's test of counts against expected ones. Cells that expect fewer than `minimum` are
// pooled.
struct ChiSquare {
  double statistic = 0;
  int degreesOfFreedom = 0;
  double pValue = 1;  // chance of a statistic as large where the distribution is right
};
ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected,
                        double minimum = 5);

// Mean and variance of independent repeats.
struct Moments {
  int count = 0;
  double mean = 0, variance = 0;  // unbiased sample variance

  static Moments of(std::span<const double> values);
};

// Chance of means as far apart where both are equal (Welch's t-test, two-sided).
double welchTest(const Moments& a, const Moments& b);
// The same against a number known exactly.
double tTest(const Moments& a, double truth);

// The significance each of `tests` independent tests must have, for a chance of `significance` that
// any of them fails wrongly (Sidak 1967).
double sidak(double significance, int tests);

}  // namespace chromeball
