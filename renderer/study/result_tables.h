// SPDX-License-Identifier: Apache-2.0
// The results of a comparison as CSV, JSON and text.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "measure/bias_variance.h"
#include "session/render_report.h"
#include "study/results.h"

namespace chromeball {

// One row for each strategy and budget, with 95% confidence intervals.
std::string resultsCsv(const StudyResults& results);

// The same, with slopes, agreement of pairs and settings.
nlohmann::ordered_json resultsJson(const Study& study, const StudyResults& results,
                                   const Machine& machine);

// A table for a terminal: the strategies with the largest common budget, the most efficient first,
// those that have missed light last.
std::string resultsTable(const Study& study, const StudyResults& results);

// The cells of that table, in its order.
std::vector<const Cell*> ranking(const Study& study, const StudyResults& results);

// Formats numbers with their confidence intervals, in as many digits as are significant.

struct EstimateText {
  std::string number, halfInterval;  // "19000", "23000": rounded to the same decimal place
  bool isSignificant;                // the 95% confidence interval excludes 0
};

// Rounds half the 95% interval to one digit (two if the first is 1), the number to the same place.
EstimateText estimateText(const Estimate& e);

// "3.1 +- 0.4"; "1" if the number is exact; "not significant (+- 23000)" if the interval includes
// 0.
std::string significantText(const Estimate& e);

// The same for a mean of numbers that are not negative. Where its interval includes 0, because a
// few numbers are most of it, the one of its logarithm is given: "690 (98 to 4800)". (Its standard
// error exceeds the mean only if something has been subtracted.)
std::string positiveText(const Estimate& e);

// The bias in percent. That of a row that has missed light is none of its method: "-18.1 (light not
// found)".
std::string biasText(const Estimate& bias, FoundLight light);

std::string ratioText(const RatioEstimate& r);  // "1.39 (1.22 to 1.58)"; "1" if it is exact

// `digits` significant digits, without an exponent up to 1e7.
std::string shortNumber(double x, int digits = 3);

// A summary of a comparison in words.

// With the largest common budget, at equal time: the unbiased strategy to use, any that do not
// differ from it significantly, and the lead over the next one; then, in one line, the biased
// strategies that are more efficient. A row that has missed light is not one to use; if all
// unbiased ones have, a sentence says so. Empty if no budget has been rendered with all strategies.
std::vector<std::string> verdict(const Study& study, const StudyResults& results);

}  // namespace chromeball
