// SPDX-License-Identifier: Apache-2.0
// Every number of a comparison, for other programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "job/machine.h"
#include "study/results.h"

namespace chromeball {

// A row for every strategy and budget; intervals hold the truth in 95 of 100 cases.
std::string resultsCsv(const StudyResults& results);

// The same, and slopes, agreement and settings.
nlohmann::ordered_json resultsJson(const Study& study, const StudyResults& results,
                                   const Machine& machine);

// For a terminal: the strategies on the largest common budget, the most efficient first.
std::string resultsTable(const Study& study, const StudyResults& results);

// Their cells on that budget, the most efficient first.
std::vector<const Cell*> ranking(const Study& study, const StudyResults& results);

}  // namespace chromeball
