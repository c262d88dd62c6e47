// SPDX-License-Identifier: Apache-2.0
#include "measure/agreement.h"

#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "measure/statistics.h"

namespace chromeball {
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

}  // namespace chromeball
