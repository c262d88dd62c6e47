// SPDX-License-Identifier: Apache-2.0
#include "measure/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <cassert>
#include <cmath>
#include <limits>

namespace chromeball {
namespace {

double twoSided(double t, double degreesOfFreedom) {
  if (std::isnan(t)) return 0;
  if (std::isinf(t)) return 0;
  using boost::math::students_t;
  return 2 * cdf(complement(students_t(degreesOfFreedom), std::fabs(t)));
}

}  // namespace

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

Moments Moments::of(std::span<const double> values) {
  Moments m;
  double scatter = 0;
  for (double x : values) {
    const double delta = x - m.mean;
    m.mean += delta / ++m.count;
    scatter += delta * (x - m.mean);
  }
  m.variance = m.count > 1 ? scatter / (m.count - 1) : 0;
  return m;
}

double welchTest(const Moments& a, const Moments& b) {
  const double va = a.variance / a.count, vb = b.variance / b.count;
  if (va + vb == 0) return a.mean == b.mean ? 1 : 0;
  const double degreesOfFreedom =
      (va + vb) * (va + vb) / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
  return twoSided((a.mean - b.mean) / std::sqrt(va + vb), degreesOfFreedom);
}

double tTest(const Moments& a, double truth) {
  if (a.variance == 0) return a.mean == truth ? 1 : 0;
  return twoSided((a.mean - truth) / std::sqrt(a.variance / a.count), a.count - 1);
}

double sidak(double significance, int tests) {
  return -std::expm1(std::log1p(-significance) / tests);
}

Estimate meanOf(std::span<const double> numbers) {
  double mean = 0, scatter = 0;
  const double n = double(numbers.size());
  for (const double x : numbers) mean += x / n;
  for (const double x : numbers) scatter += (x - mean) * (x - mean);
  return {mean, n > 1 ? std::sqrt(scatter / (n - 1) / n) : 0};
}

Estimate weightedMean(std::span<const Estimate> estimates) {
  double weights = 0, mean = 0;
  for (const Estimate& e : estimates) {
    if (!(e.standardError > 0)) continue;
    const double weight = 1 / (e.standardError * e.standardError);
    weights += weight;
    mean += weight * e.mean;
  }
  if (!(weights > 0)) return {};
  return {mean / weights, 1 / std::sqrt(weights)};
}

}  // namespace chromeball
