// SPDX-License-Identifier: Apache-2.0
// What the renders of a study say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "measure/agreement.h"
#include "measure/power_law.h"
#include "study/render_store.h"

namespace chromeball {

// All repeats of a strategy on a budget.
struct Cell {
  std::string strategy;
  Budget budget;
  CellError error;
  double samples = 0;                 // mean over the repeats
  std::vector<double> repeatSeconds;  // of rendering, in order; as many as repeats
  Estimate seconds;                   // their mean
  double prepareSeconds = 0;          // of building the strategy, which all its renders share
  double noise = 0;                   // mean of what the renders themselves report
  double invalidSamples = 0;
  // 1 / (relMse seconds), relative to the baseline on the same budget. Seconds are compared repeat
  // by repeat: strategies take turns, so a machine that drifts slows a turn's renders alike.
  Estimate efficiency;
};

struct StrategyResult {
  std::string name;
  bool unbiased = true;
  std::vector<Cell> cells;                   // in the order of the budgets
  std::optional<PowerLaw> variance, relMse;  // against samples
  Estimate squaredBias;                      // from all cells
  std::optional<Crossing> biasEqualsNoise;
};

struct PairResult {
  std::string a, b;
  Budget budget;
  Agreement agreement;
};

// Unbiased strategies are compared on the largest budget that all have. One whose relMSE is above
// this has not met all the light: its repeats agree on what they have not seen.
inline constexpr double kMaxNoiseOfPairs = 0.25;

struct StudyResults {
  Reference reference;
  bool referenceErrorKnown = true;
  double referenceNoise = 0;  // relative standard error of its mean pixel
  std::vector<StrategyResult> strategies;
  std::vector<PairResult> pairs;      // of strategies that can be compared, on that budget
  std::vector<std::string> warnings;  // what a reader should know before trusting the numbers
  bool complete = true;               // every cell of this run is here
};

// The reference as it is on file, or as its parts make it. Throws InputError where its file does
// not fit the picture's size.
Reference loadReference(const Study& study, const RenderStore& store, int width, int height);

// From those cells of which enough repeats are stored.
StudyResults studyResults(const Study& study, const RenderStore& store, const Reference& reference);

// The cell of a strategy on a budget; null where it is not there yet.
const Cell* findCell(const StrategyResult& strategy, const Budget& budget);

// The largest budget (of those wanted) on which every strategy of this run has its cell; nullopt
// where there is none. Of those that runs before left behind, some may lack it.
std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results);
std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results,
                                          bool (*isWanted)(const Budget&));

}  // namespace chromeball
