// SPDX-License-Identifier: Apache-2.0
#include "hypothesis.h"

#include <cmath>

namespace chromeball {

double tTest(const Moments& a, double truth) {
  if (a.variance == 0) return a.mean == truth ? 1 : 0;
  return twoSidedStudent((a.mean - truth) / std::sqrt(a.variance / a.count), a.count - 1);
}

}  // namespace chromeball
