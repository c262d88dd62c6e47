// SPDX-License-Identifier: Apache-2.0
#include "measure/estimate.h"

#include <cmath>

namespace chromeball {

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
