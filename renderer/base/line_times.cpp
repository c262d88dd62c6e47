// SPDX-License-Identifier: Apache-2.0
#include "base/line_times.h"

#include <cmath>

namespace chromeball {

bool LineTimes::isDue(double fraction, double seconds) {
  constexpr double kLeast = 10, kMost = 60;
  const double since = seconds - seconds_;
  const bool isTenth = std::floor(10 * fraction) > std::floor(10 * fraction_);
  if (since < kLeast || !(isTenth || since >= kMost)) return false;
  if (!std::isnan(fraction)) fraction_ = fraction;
  seconds_ = seconds;
  return true;
}

}  // namespace chromeball
