// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

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

}  // namespace chromeball
