// SPDX-License-Identifier: Apache-2.0
// "Did you mean ...?": the known name nearest to one that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chromeball {

// Fewest single-character edits that turn `a` into `b`: insert, delete, replace, or swap two
// neighbours (optimal string alignment; Damerau 1964). O(|a| |b|).
int editDistance(std::string_view a, std::string_view b);

// The known name at the least distance from `name`; empty where even that one takes more edits than
// half the letters of the longer of the two. Of several as near, the first.
std::string_view nearestName(std::string_view name, const std::vector<std::string_view>& known);

// "did you mean `NEAREST`?", or where none is near "known: A, B, C". Ends an error's sentence.
std::string didYouMean(std::string_view name, const std::vector<std::string_view>& known);

}  // namespace chromeball
