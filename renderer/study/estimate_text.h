// SPDX-License-Identifier: Apache-2.0
// Numbers with their errors, in as many digits as they deserve.
#pragma once

#include <string>

#include "measure/bias_variance.h"

namespace chromeball {

struct EstimateText {
  std::string number, halfInterval;  // "19000", "23000": to the same decimal place
  bool isResolved;                   // the interval of 95% leaves out 0
};

// Half the interval to one digit (two where the first is 1), the number to the same place.
EstimateText estimateText(const Estimate& e);

// "3.1 +- 0.4", "1" where it is exact; "not resolved (+- 23000)" where the interval holds 0.
std::string resolvedText(const Estimate& e);

// `digits` significant digits, and no powers of ten where people can do without.
std::string shortNumber(double x, int digits = 3);

}  // namespace chromeball
