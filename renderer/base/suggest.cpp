// SPDX-License-Identifier: Apache-2.0
#include "base/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace chromeball {

int editDistance(std::string_view a, std::string_view b) {
  // Three rows of the table d(i, j) = distance between the first i letters of a and the first j of
  // b.
  std::vector<int> beforeLast(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = int(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
    beforeLast.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

std::string_view nearestName(std::string_view name, const std::vector<std::string_view>& known) {
  std::string_view nearest;
  int nearestDistance = 0;
  for (std::string_view candidate : known) {
    const auto [shorter, longer] = std::minmax({name.size(), candidate.size()});
    if ((longer - shorter) * 2 > longer) continue;  // the distance is at least the difference
    const int distance = editDistance(name, candidate);
    if (size_t(distance) * 2 > longer) continue;
    if (!nearest.empty() && distance >= nearestDistance) continue;
    nearest = candidate;
    nearestDistance = distance;
  }
  return nearest;
}

std::string didYouMean(std::string_view name, const std::vector<std::string_view>& known) {
  const std::string_view nearest = nearestName(name, known);
  if (nearest.empty()) return fmt::format("known: {}", fmt::join(known, ", "));
  return fmt::format("did you mean `{}`?", nearest);
}

}  // namespace chromeball
