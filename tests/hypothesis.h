// SPDX-License-Identifier: Apache-2.0
// Hypothesis tests of distributions and means, besides those of measure/statistics.h.
#pragma once

#include <span>

#include "measure/statistics.h"

namespace chromeball {

// Pearson's chi-square test of observed against expected counts. Cells with an expected count below
// `minimum` are pooled.
struct ChiSquare {
  double statistic = 0;
  int degreesOfFreedom = 0;
  double pValue = 1;  // probability of such a statistic if the distribution is as expected
};
ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected,
                        double minimum = 5);

// p-value of the hypothesis that the mean is `truth` (t-test, two-sided).
double tTest(const Moments& a, double truth);

}  // namespace chromeball
