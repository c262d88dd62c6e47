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

// A table for a terminal: the strategies with the largest common budget, the most efficient first.
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

// `digits` significant digits, without an exponent up to 1e7.
std::string shortNumber(double x, int digits = 3);

// A summary of a comparison in words.

// One sentence each: the strategy with the smallest error at equal samples, and at equal time, with
// its lead and the confidence interval of that; for each biased strategy the size of its bias and
// the number of samples above which bias exceeds noise. Empty if no budget has been rendered with
// all strategies and no strategy is biased.
std::vector<std::string> verdict(const Study& study, const StudyResults& results);

}  // namespace chromeball
