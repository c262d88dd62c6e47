// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?": suggests the known name nearest to an unknown one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// Minimum number of single-character edits that turn `a` into `b`: insert, delete, replace, or swap
// two neighbours (optimal string alignment; Damerau 1964). O(|a| |b|).
int editDistance(std::string_view a, std::string_view b);

// The known name with the smallest edit distance from `name`, the first of several; empty if that
// distance is more than half the length of the longer name.
std::string_view nearestName(std::string_view name, const std::vector<std::string_view>& known);

// "did you mean `NEAREST`?", or "known: A, B, C" if no name is near. The end of an error message.
std::string didYouMean(std::string_view name, const std::vector<std::string_view>& known);

}  // namespace chromeball
