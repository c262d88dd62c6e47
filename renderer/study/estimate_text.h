// SPDX-License-Identifier: Apache-2.0
// Formats numbers with their confidence intervals, in as many digits as are significant.
#pragma once

#include <string>

#include "measure/bias_variance.h"

namespace chromeball {

struct EstimateText {
  std::string number, halfInterval;  // "19000", "23000": rounded to the same decimal place
  bool isSignificant;                // the 95% confidence interval excludes 0
};

// Rounds half the 95% interval to one digit (two if the first is 1), the number to the same place.
EstimateText estimateText(const Estimate& e);

// "3.1 +- 0.4"; "1" if the number is exact; "not significant (+- 23000)" if the interval includes
// 0.
std::string significantText(const Estimate& e);

// `digits` significant digits, without an exponent up to 1e7.
std::string shortNumber(double x, int digits = 3);

}  // namespace chromeball
