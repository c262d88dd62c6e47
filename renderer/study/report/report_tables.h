// SPDX-License-Identifier: Apache-2.0
// The tables of the report, in HTML.
#pragma once

#include <string>

#include "study/results.h"

namespace chromeball {

// The strategies with the largest common budget, the most efficient first.
std::string resultsHtml(const Study& study, const StudyResults& results);

// The pairs of unbiased strategies that were tested for agreement.
std::string pairsHtml(const StudyResults& results);

}  // namespace chromeball
