// SPDX-License-Identifier: Apache-2.0
#include "measure/chi_square.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>
#include <cmath>
#include <limits>

namespace chromeball {

ChiSquare chiSquareTest(std::span<const double> observed, std::span<const double> expected,
                        double minimum) {
  assert(observed.size() == expected.size());
  ChiSquare result;
  int cells = 0;
  double pooledObserved = 0, pooledExpected = 0;
  const auto add = [&](double o, double e) {
    result.statistic += (o - e) * (o - e) / e;
    ++cells;
  };
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] >= minimum) {
      add(observed[i], expected[i]);
    } else {
      pooledObserved += observed[i];
      pooledExpected += expected[i];
    }
  }
  if (pooledExpected >= minimum) {
    add(pooledObserved, pooledExpected);
  } else if (pooledObserved > pooledExpected + 8 * std::sqrt(minimum)) {
    result.statistic = std::numeric_limits<double>::infinity();  // samples where none are expected
  }
  result.degreesOfFreedom = std::max(cells - 1, 0);
  if (std::isinf(result.statistic) || std::isnan(result.statistic))
    result.pValue = 0;
  else if (result.degreesOfFreedom > 0)
    result.pValue =
        cdf(complement(boost::math::chi_squared(result.degreesOfFreedom), result.statistic));
  return result;
}

}  // namespace chromeball
