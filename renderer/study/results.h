// SPDX-License-Identifier: Apache-2.0
// The results of a study, computed from its renders.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measure/bias_variance.h"
#include "measure/statistics.h"
#include "study/render_store.h"

namespace chromeball {

// Whether the samples of a row have found the light that the reference has.

enum class FoundLight {
  All,    // as far as can be seen
  Few,    // single bright samples may make up most of the error, so that its interval is too narrow
  Missed  // no or hardly any sample has met rare bright light: neither error nor bias is known
};

// The least upper end of relMSE's interval that makes FoundLight::Few: the variance above it is
// underestimated.
inline constexpr double kMaxNoiseOfPairs = 0.25;

// `unbiased`: by construction. Then a mean that is significantly below the reference's is no bias:
// light that no repeat has met is missing in the mean, and in the scatter that would tell so. Of
// other rows, it may be their bias.
FoundLight foundLight(const BiasVariance& error, bool unbiased);

struct LightOfRow {
  std::string name;
  FoundLight light;
  double bias;  // BiasVariance::bias
};

// What to say of these rows, which are not known to be biased; each is in one of the warnings at
// most. `referenceIsGiven`: it may be of another scene.
std::vector<std::string> lightWarnings(std::span<const LightOfRow> rows, bool referenceIsGiven);

// The results of a study, computed from its renders.

// The results of one strategy for one budget, over all repeats.
struct Cell {
  std::string strategy;
  Budget budget;
  BiasVariance error;
  double samples = 0;                  // mean over the repeats
  std::vector<double> repeatSeconds;   // render time of each repeat, in order
  Estimate seconds;                    // its mean
  double prepareSeconds = 0;           // time to build the strategy, once for all its renders
  double noise = 0;                    // mean of the noise that the renders themselves report
  double invalidSamples = 0;           // sum over the repeats
  FoundLight light = FoundLight::All;  // foundLight() of the error
  RatioEstimate efficiency;  // relative to the baseline with the same budget; unknown if Missed
};

// 1 / (relMse seconds) of `cell` over that of `other`. Times are compared repeat by repeat:
// strategies alternate, so that a machine whose speed drifts slows all strategies of a repeat
// alike.
RatioEstimate relativeEfficiency(const Cell& cell, const Cell& other);

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

struct StudyResults {
  Reference reference;
  bool referenceErrorKnown = true;
  double referenceNoise = 0;  // relative standard error of its mean pixel
  std::vector<StrategyResult> strategies;
  // The one whose efficiency is 1: that of the study, or the unbiased one that is the most
  // efficient with the largest common budget, of those that have found the light. Its noise blurs
  // all other efficiencies.
  std::string baseline;
  std::vector<PairResult> pairs;      // all pairs of unbiased strategies with FoundLight::All
  std::vector<std::string> warnings;  // reasons to distrust some of the numbers
  bool complete = true;               // whether every cell of this run exists
};

// Uses the cells with at least Study::kMinRepeats stored repeats.
StudyResults studyResults(const Study& study, const RenderStore& store, const Reference& reference);

// The cell of a strategy for a budget; null if it does not exist yet.
const Cell* findCell(const StrategyResult& strategy, const Budget& budget);

// The largest budget (with isWanted(budget)) for which all strategies of this run have a cell;
// nullopt if there is none. Strategies from earlier runs need not have a cell for it.
std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results);
std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results,
                                          bool (*isWanted)(const Budget&));

}  // namespace chromeball
