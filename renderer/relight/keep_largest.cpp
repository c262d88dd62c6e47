// SPDX-License-Identifier: Apache-2.0
#include "relight/keep_largest.h"

#include <algorithm>
#include <numeric>

namespace chromeball {

void Magnitudes::add(const Magnitudes& other) {
  for (size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

size_t Magnitudes::leastBin(double share) const {
  const uint64_t all = std::accumulate(counts_.begin(), counts_.end(), uint64_t(0));
  const auto most = uint64_t(share * double(all) + 0.5);
  uint64_t kept = 0;
  size_t least = counts_.size();
  while (least > 0 && kept + counts_[least - 1] <= most) kept += counts_[--least];
  while (least > 0 && kept == 0) kept += counts_[--least];  // never nothing
  return least;
}

uint64_t dropBelow(size_t leastBin, std::span<float> values) {
  uint64_t zeros = 0;
  for (float& value : values) {
    if (Magnitudes::binOf(value) < leastBin) value = 0;
    zeros += value == 0;
  }
  return zeros;
}

double keepLargest(std::span<float> values, double share) {
  Magnitudes all;
  all.add(values);
  return double(dropBelow(all.leastBin(share), values)) /
         double(std::max<size_t>(values.size(), 1));
}

}  // namespace chromeball
