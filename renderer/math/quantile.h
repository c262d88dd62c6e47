// SPDX-License-Identifier: Apache-2.0
// Quantiles of numbers.
#pragma once

#include <algorithm>
#include <cassert>
#include <vector>

namespace chromeball {

// The number that `fraction` of the others, 0 to 1, are below: one of `values`, which are not
// empty.
template <class T>
T quantile(std::vector<T> values, double fraction) {
  assert(!values.empty());
  const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace chromeball
