// SPDX-License-Identifier: Apache-2.0
// What a comparison comes to, in words.
#pragma once

#include <string>
#include <vector>

#include "study/results.h"

namespace chromeball {

// One sentence each: which strategy has the least error at equal samples, which at equal time, by
// how much and how surely; of each biased strategy how large its bias is, and from how many samples
// on it exceeds the noise. Empty where no budget has been rendered by all strategies.
std::vector<std::string> verdict(const Study& study, const StudyResults& results);

}  // namespace chromeball
