// SPDX-License-Identifier: Apache-2.0
#include "study/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/result_tables.h"

namespace chromeball {
namespace {

// A strategy and its cost; smaller is better.
struct Contender {
  const Cell* cell;
  Estimate cost;
};

// a / b, with the standard error to first order.
Estimate ratio(const Estimate& a, const Estimate& b) {
  const double mean = a.mean / b.mean;
  return {mean, std::fabs(mean) * std::hypot(a.standardError / a.mean, b.standardError / b.mean)};
}

Estimate relMse(const Cell& cell) { return cell.error.relMse; }

// relMSE x seconds: for an unbiased strategy the relMSE after one second.
Estimate relMseTimesSeconds(const Cell& cell) {
  const Estimate &e = cell.error.relMse, &s = cell.seconds;
  const double mean = e.mean * s.mean;
  return {mean, std::hypot(e.standardError * s.mean, s.standardError * e.mean)};
}

std::vector<Contender> contenders(const StudyResults& results, const Budget& budget,
                                  Estimate (*cost)(const Cell&)) {
  std::vector<Contender> sorted;
  for (const StrategyResult& strategy : results.strategies)
    if (const Cell* cell = findCell(strategy, budget)) sorted.push_back({cell, cost(*cell)});
  std::stable_sort(sorted.begin(), sorted.end(), [](const Contender& a, const Contender& b) {
    return a.cost.mean < b.cost.mean;
  });
  return sorted;
}

// "bsdf has 1.9 +- 0.2 times its relMSE", or that the difference is not significant.
std::string lead(const Contender& best, const Contender& other, const char* metric) {
  const Estimate times = ratio(other.cost, best.cost);
  if (!(times.low() > 1))
    return fmt::format("{} does not differ significantly", other.cell->strategy);
  const EstimateText text = estimateText(times);
  return fmt::format("{} has {} +- {} times its {}", other.cell->strategy, text.number,
                     text.halfInterval, metric);
}

std::string winner(const std::vector<Contender>& sorted, const std::string& condition,
                   const char* metric, const std::string& baseline) {
  const Contender& best = sorted.front();
  std::string sentence =
      fmt::format("{}: {} has the smallest {}", condition, best.cell->strategy, metric);
  if (sorted.size() > 1) sentence += "; " + lead(best, sorted[1], metric);
  for (size_t i = 2; i < sorted.size(); ++i)
    if (sorted[i].cell->strategy == baseline) sentence += ", " + lead(best, sorted[i], metric);
  return sentence + ".";
}

std::string biasOf(const StrategyResult& strategy, bool hasNoisyReference) {
  const EstimateText size = estimateText(strategy.squaredBias);
  if (strategy.cells.empty()) return "";
  if (!(strategy.squaredBias.low() > 0))
    return fmt::format("{} is biased, but its bias is not significant{}.", strategy.name,
                       hasNoisyReference ? " given the noise of this reference" : "");
  std::string sentence = fmt::format(
      "{} is biased: a relMSE of {} +- {} remains with any number "
      "of samples",
      strategy.name, size.number, size.halfInterval);
  if (const auto& crossing = strategy.biasEqualsNoise)
    sentence += fmt::format("; bias exceeds noise above {} samples per pixel ({} to {})",
                            shortNumber(crossing->samples, 2), shortNumber(crossing->low, 2),
                            shortNumber(crossing->high, 2));
  return sentence + ".";
}

}  // namespace

std::vector<std::string> verdict(const Study& study, const StudyResults& results) {
  std::vector<std::string> sentences;
  const auto samples =
      largestCommonBudget(study, results, [](const Budget& budget) { return !budget.timed; });
  const auto seconds =
      largestCommonBudget(study, results, [](const Budget& budget) { return budget.timed; });
  if (samples)
    sentences.push_back(winner(contenders(results, *samples, relMse),
                               fmt::format("At equal samples ({})", samples->label()), "relMSE",
                               study.baseline));
  if (seconds)
    sentences.push_back(winner(contenders(results, *seconds, relMse),
                               fmt::format("At equal time ({})", seconds->label()), "relMSE",
                               study.baseline));
  else if (samples)
    sentences.push_back(
        winner(contenders(results, *samples, relMseTimesSeconds),
               fmt::format("At equal time (extrapolated from {})", samples->label()),
               "relMSE x seconds", study.baseline));
  for (const StrategyResult& strategy : results.strategies)
    if (!strategy.unbiased)
      if (std::string text = biasOf(strategy, results.referenceErrorKnown); !text.empty())
        sentences.push_back(std::move(text));
  return sentences;
}

}  // namespace chromeball
