// SPDX-License-Identifier: Apache-2.0
#include "measure/statistics.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace chromeball {
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

double twoSidedStudent(double t, double degreesOfFreedom) {
  if (std::isnan(t) || std::isinf(t)) return 0;
  return 2 * cdf(complement(boost::math::students_t(degreesOfFreedom), std::fabs(t)));
}

double welchTest(const Moments& a, const Moments& b) {
  const double va = a.variance / a.count, vb = b.variance / b.count;
  if (va + vb == 0) return a.mean == b.mean ? 1 : 0;
  const double degreesOfFreedom =
      (va + vb) * (va + vb) / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
  return twoSidedStudent((a.mean - b.mean) / std::sqrt(va + vb), degreesOfFreedom);
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

RatioEstimate operator*(const RatioEstimate& a, const RatioEstimate& b) {
  return {a.value * b.value, std::hypot(a.logError, b.logError)};
}

RatioEstimate ratio(const Estimate& a, const Estimate& b) {
  if (!(a.mean > 0 && b.mean > 0)) return {std::nan(""), 0};
  return {a.mean / b.mean, std::hypot(a.standardError / a.mean, b.standardError / b.mean)};
}

RatioEstimate pairedRatio(std::span<const double> a, std::span<const double> b) {
  std::vector<double> logs;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) logs.push_back(std::log(a[i] / b[i]));
  const Estimate log = meanOf(logs);
  if (logs.size() < 2) return {std::exp(log.mean), 0};
  const boost::math::students_t student(double(logs.size()) - 1);
  return {std::exp(log.mean), log.standardError * quantile(student, 0.975) / 1.96};
}

namespace {

constexpr int kTile = Agreement::kTile;
// Relative differences of means below this are rounding errors.
constexpr double kRounding = 1e-5;

double meanLuminance(const Image& image, int left, int top) {
  double sum = 0;
  int count = 0;
  for (int y = top; y < std::min(top + kTile, image.height); ++y)
    for (int x = left; x < std::min(left + kTile, image.width); ++x, ++count)
      sum += luminance(image.rgb(x, y));
  return sum / count;
}

Moments tileMoments(std::span<const Image> images, int left, int top) {
  std::vector<double> means;
  for (const Image& image : images) means.push_back(meanLuminance(image, left, top));
  return Moments::of(means);
}

double pValueOf(const Moments& a, const Moments& b) {
  if (std::fabs(a.mean - b.mean) <= kRounding * std::fabs(b.mean)) return 1;
  return welchTest(a, b);
}

// The normal deviate with the two-sided p-value `p` and the sign of `difference`.
double deviate(double p, double difference) {
  constexpr double kMinP = 1e-300;  // p = 0 would give an infinite deviate
  const double z = quantile(complement(boost::math::normal(), std::max(p, kMinP) / 2));
  return std::copysign(z, difference);
}

}  // namespace

Agreement agreement(std::span<const Image> a, std::span<const Image> b) {
  const int columns = (a[0].width + kTile - 1) / kTile, rows = (a[0].height + kTile - 1) / kTile;
  Agreement result;
  result.z = Image(columns, rows, 1);
  result.tiles = result.z.texels.size();
  const double significance = sidak(0.05, int(result.tiles));
  double minimum = 1;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const Moments ma = tileMoments(a, x * kTile, y * kTile);
      const Moments mb = tileMoments(b, x * kTile, y * kTile);
      const double p = pValueOf(ma, mb);
      *result.z.at(x, y) = float(deviate(p, ma.mean - mb.mean));
      result.fraction += (p < significance) / double(result.tiles);
      minimum = std::min(minimum, p);
    }
  // The probability that the minimum of this many p-values is this small.
  result.pValue = -std::expm1(double(result.tiles) * std::log1p(-minimum));
  return result;
}

double chiSquarePValue(double statistic, int degreesOfFreedom) {
  if (!std::isfinite(statistic)) return 0;
  if (degreesOfFreedom < 1) return 1;
  return cdf(complement(boost::math::chi_squared(degreesOfFreedom), statistic));
}

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
  result.pValue = chiSquarePValue(result.statistic, result.degreesOfFreedom);
  return result;
}

}  // namespace chromeball
