// SPDX-License-Identifier: Apache-2.0
// Hypothesis tests of means, besides those of measure/statistics.h.
#pragma once

#include "measure/statistics.h"

namespace chromeball {

// p-value of the hypothesis that the mean is `truth` (t-test, two-sided).
double tTest(const Moments& a, double truth);

}  // namespace chromeball
