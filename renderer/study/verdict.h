// SPDX-License-Identifier: Apache-2.0
// A summary of a comparison in words.
#pragma once

#include <string>
#include <vector>

#include "study/results.h"

namespace chromeball {

// One sentence each: the strategy with the smallest error at equal samples, and at equal time, with
// its lead and the confidence interval of that; for each biased strategy the size of its bias and
// the number of samples above which bias exceeds noise. Empty if no budget has been rendered with
// all strategies and no strategy is biased.
std::vector<std::string> verdict(const Study& study, const StudyResults& results);

}  // namespace chromeball
