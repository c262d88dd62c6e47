// SPDX-License-Identifier: Apache-2.0
// The results of a comparison as CSV, JSON and text.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "session/machine.h"
#include "study/results.h"

namespace chromeball {

// One row for each strategy and budget, with 95% confidence intervals.
std::string resultsCsv(const StudyResults& results);

// The same, with slopes, agreement of pairs and settings.
nlohmann::ordered_json resultsJson(const Study& study, const StudyResults& results,
                                   const Machine& machine);

// For a terminal: the strategies with the largest common budget, the most efficient first.
std::string resultsTable(const Study& study, const StudyResults& results);

// The cells of that table, in its order.
std::vector<const Cell*> ranking(const Study& study, const StudyResults& results);

}  // namespace chromeball
