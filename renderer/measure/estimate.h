// SPDX-License-Identifier: Apache-2.0
// An estimated number with its standard error.
#pragma once

#include <span>

namespace chromeball {

struct Estimate {
  double mean = 0, standardError = 0;

  // The 95% confidence interval, for normal errors.
  double low() const { return mean - 1.96 * standardError; }
  double high() const { return mean + 1.96 * standardError; }
};

// The mean of independent numbers; its standard error is 0 for a single number.
Estimate meanOf(std::span<const double> numbers);

// The mean of estimates of one number, weighted by their inverse variances. Ignores estimates whose
// standard error is 0; {0, 0} if none is left.
Estimate weightedMean(std::span<const Estimate> estimates);

}  // namespace chromeball
