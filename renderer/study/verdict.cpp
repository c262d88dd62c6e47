// SPDX-License-Identifier: Apache-2.0
#include "study/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/estimate_text.h"

namespace chromeball {
namespace {

// A strategy and what it costs: smaller is better.
struct Contender {
  const Cell* cell;
  Estimate cost;
};

// a / b, with the error to first order.
Estimate ratio(const Estimate& a, const Estimate& b) {
  const double mean = a.mean / b.mean;
  return {mean, std::fabs(mean) * std::hypot(a.standardError / a.mean, b.standardError / b.mean)};
}

// relMSE, and relMSE x seconds: the error after one second, where it is all noise.
Estimate error(const Cell& cell) { return cell.error.relMse; }
Estimate work(const Cell& cell) {
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

// "1.9 +- 0.2 times", or that the two cannot be told apart.
std::string lead(const Contender& best, const Contender& other, const char* of) {
  const Estimate times = ratio(other.cost, best.cost);
  if (!(times.low() > 1))
    return fmt::format("{} cannot be told apart from it", other.cell->strategy);
  const EstimateText text = estimateText(times);
  return fmt::format("{} has {} +- {} times its {}", other.cell->strategy, text.number,
                     text.halfInterval, of);
}

std::string winner(const std::vector<Contender>& sorted, const std::string& where, const char* of,
                   const std::string& baseline) {
  const Contender& best = sorted.front();
  std::string sentence = fmt::format("{}: {} has the least {}", where, best.cell->strategy, of);
  if (sorted.size() > 1) sentence += "; " + lead(best, sorted[1], of);
  for (size_t i = 2; i < sorted.size(); ++i)
    if (sorted[i].cell->strategy == baseline) sentence += ", " + lead(best, sorted[i], of);
  return sentence + ".";
}

std::string biasOf(const StrategyResult& strategy, bool hasNoisyReference) {
  const EstimateText size = estimateText(strategy.squaredBias);
  if (strategy.cells.empty()) return "";
  if (!(strategy.squaredBias.low() > 0))
    return fmt::format("{} is biased, but its bias is not resolved{}.", strategy.name,
                       hasNoisyReference ? " beside the noise of this reference" : "");
  std::string sentence = fmt::format("{} is biased: {} +- {} of its relMSE stays", strategy.name,
                                     size.number, size.halfInterval);
  if (const auto& crossing = strategy.biasEqualsNoise)
    return sentence + fmt::format("; bias exceeds noise from {} samples a pixel on ({} to {}).",
                                  shortNumber(crossing->samples, 2), shortNumber(crossing->low, 2),
                                  shortNumber(crossing->high, 2));
  return sentence + " however many samples it takes.";
}

}  // namespace

std::vector<std::string> verdict(const Study& study, const StudyResults& results) {
  std::vector<std::string> sentences;
  const auto samples =
      largestCommonBudget(study, results, [](const Budget& budget) { return !budget.timed; });
  const auto seconds =
      largestCommonBudget(study, results, [](const Budget& budget) { return budget.timed; });
  if (samples)
    sentences.push_back(winner(contenders(results, *samples, error),
                               fmt::format("At equal samples ({})", samples->label()), "relMSE",
                               study.baseline));
  if (seconds)
    sentences.push_back(winner(contenders(results, *seconds, error),
                               fmt::format("At equal time ({})", seconds->label()), "relMSE",
                               study.baseline));
  else if (samples)
    sentences.push_back(winner(contenders(results, *samples, work),
                               fmt::format("At equal time (by {})", samples->label()),
                               "relMSE x seconds", study.baseline));
  for (const StrategyResult& strategy : results.strategies)
    if (!strategy.unbiased)
      if (std::string text = biasOf(strategy, results.referenceErrorKnown); !text.empty())
        sentences.push_back(std::move(text));
  return sentences;
}

}  // namespace chromeball
