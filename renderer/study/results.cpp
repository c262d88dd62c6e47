// SPDX-License-Identifier: Apache-2.0
#include "study/results.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace chromeball {
namespace {

// There is a warning if the reference's variance is above this fraction of a relMSE.
constexpr double kMaxReferenceFraction = 0.1;

double mean(const std::vector<StoredRender>& renders, double StoredRender::*member) {
  double sum = 0;
  for (const StoredRender& render : renders) sum += render.*member;
  return sum / double(renders.size());
}

// All stored repeats; empty if there are fewer than Study::kMinRepeats.
std::vector<StoredRender> loadRepeats(const RenderStore& store, const std::string& strategy,
                                      const Budget& budget) {
  std::vector<StoredRender> renders;
  while (std::optional<StoredRender> render = store.find({strategy, budget, int(renders.size())}))
    renders.push_back(*std::move(render));
  if (renders.size() < size_t(Study::kMinRepeats)) return {};
  return renders;
}

bool isComplete(const Study& study, const StudyResults& results) {
  for (const StrategyResult& strategy : results.strategies) {
    if (std::count(study.strategies.begin(), study.strategies.end(), strategy.name) == 0) continue;
    for (const Budget& budget : study.budgets) {
      const Cell* cell = findCell(strategy, budget);
      if (!cell || int(cell->repeatSeconds.size()) < study.repeats) return false;
    }
  }
  return true;
}

std::vector<Image> images(std::vector<StoredRender> renders) {
  std::vector<Image> result;
  for (StoredRender& render : renders) result.push_back(std::move(render.image));
  return result;
}

Cell cellOf(const std::string& strategy, const Budget& budget, std::vector<StoredRender> renders,
            const Reference& reference) {
  Cell cell{.strategy = strategy, .budget = budget};
  for (const StoredRender& render : renders) cell.repeatSeconds.push_back(render.seconds);
  cell.samples = mean(renders, &StoredRender::samples);
  cell.seconds = meanOf(cell.repeatSeconds);
  cell.prepareSeconds = mean(renders, &StoredRender::prepareSeconds);
  cell.noise = mean(renders, &StoredRender::noise);
  cell.invalidSamples = mean(renders, &StoredRender::invalidSamples) * double(renders.size());
  const bool joins = rowNamed(strategy, "output").joinsPixels();
  const bool unbiased = renders.front().unbiased;
  cell.error = biasVariance(images(std::move(renders)), reference,
                            joins ? PixelNoise::Joined : PixelNoise::Independent);
  cell.light = foundLight(cell.error, unbiased);
  return cell;
}

// An error that is less than the noise of the reference, which was subtracted, may come out as 0 or
// negative: it is then known to be about as small as its standard error.
Estimate atLeastItsError(const Estimate& relMse) {
  return {std::max(relMse.mean, relMse.standardError), relMse.standardError};
}

// How well a cell serves as the baseline, besides its efficiency, which is unknown where it has
// missed light.
int rankOf(const StrategyResult& strategy, const Cell& cell) {
  if (cell.light == FoundLight::Missed) return 0;
  return strategy.unbiased ? 2 : 1;
}

// The unbiased strategy that is the most efficient with the largest common budget, of those that
// have found the light; if there is none, the most efficient biased one, or the first.
std::string bestBaseline(const Study& study, const StudyResults& results) {
  const std::optional<Budget> budget = largestCommonBudget(study, results);
  const StrategyResult* best = nullptr;
  const auto isBetter = [&](const StrategyResult& strategy) {
    if (!best) return true;
    const Cell &own = *findCell(strategy, *budget), &bests = *findCell(*best, *budget);
    const int lead = rankOf(strategy, own) - rankOf(*best, bests);
    return lead > 0 || (lead == 0 && relativeEfficiency(own, bests).value > 1);
  };
  for (const StrategyResult& strategy : results.strategies)
    if (budget && findCell(strategy, *budget) && isBetter(strategy)) best = &strategy;
  return best ? best->name : study.strategies.front();
}

void compareWithBaseline(StudyResults& results) {
  const auto base = std::ranges::find(results.strategies, results.baseline, &StrategyResult::name);
  for (StrategyResult& strategy : results.strategies)
    for (Cell& cell : strategy.cells) {
      const Cell* other = findCell(*base, cell.budget);
      const bool isKnown = other && cell.light != FoundLight::Missed;
      cell.efficiency = isKnown ? relativeEfficiency(cell, *other) : RatioEstimate{std::nan(""), 0};
    }
}

void fitConvergence(StrategyResult& strategy) {
  std::vector<ConvergencePoint> variances, errors;
  std::vector<BiasVariance> biases;
  for (const Cell& cell : strategy.cells) {
    variances.push_back({cell.samples, cell.error.variance});
    errors.push_back({cell.samples, cell.error.relMse});
    biases.push_back(cell.error);
  }
  strategy.variance = fitPowerLaw(variances);
  strategy.relMse = fitPowerLaw(errors);
  strategy.squaredBias = commonSquaredBias(biases);
  if (strategy.variance && !strategy.unbiased)
    strategy.biasEqualsNoise = biasEqualsNoise(*strategy.variance, strategy.squaredBias);
}

std::vector<PairResult> comparePairs(const Study& study, const RenderStore& store,
                                     const StudyResults& results) {
  const std::optional<Budget> budget = largestCommonBudget(study, results);
  std::vector<PairResult> pairs;
  std::vector<std::pair<std::string, std::vector<Image>>> sets;
  for (const StrategyResult& strategy : results.strategies)
    if (const Cell* cell = budget && strategy.unbiased ? findCell(strategy, *budget) : nullptr;
        cell && cell->light == FoundLight::All)
      sets.emplace_back(strategy.name, images(loadRepeats(store, strategy.name, *budget)));
  for (size_t i = 0; i < sets.size(); ++i)
    for (size_t j = i + 1; j < sets.size(); ++j)
      pairs.push_back(
          {sets[i].first, sets[j].first, *budget, agreement(sets[i].second, sets[j].second)});
  return pairs;
}

// Of the unbiased strategies, with the largest common budget.
std::vector<std::string> lightWarningsOf(const Study& study, const StudyResults& results) {
  std::vector<LightOfRow> rows;
  const std::optional<Budget> budget = largestCommonBudget(study, results);
  for (const StrategyResult& strategy : results.strategies)
    if (const Cell* cell = budget && strategy.unbiased ? findCell(strategy, *budget) : nullptr)
      rows.push_back({strategy.name, cell->light, cell->error.bias.mean});
  std::vector<std::string> warnings = lightWarnings(rows, !study.referenceFile.empty());
  const auto base = std::ranges::find(rows, study.baseline, &LightOfRow::name);
  if (base != rows.end() && base->light == FoundLight::Missed)
    warnings.push_back(fmt::format(
        "Efficiencies are relative to {}, which has not found the light: only their order means "
        "something. Give another baseline.",
        base->name));
  return warnings;
}

std::vector<std::string> warningsOf(const Study& study, const StudyResults& results) {
  std::vector<std::string> warnings;
  if (!results.complete)
    warnings.push_back(
        "The comparison is incomplete: some strategies have not rendered all budgets.");
  if (!results.referenceErrorKnown)
    warnings.push_back(fmt::format("{} has no variance layer, so it is assumed to be exact.",
                                   study.referenceFile));
  double worst = 0, invalid = 0;
  std::string where;
  for (const StrategyResult& strategy : results.strategies)
    for (const Cell& cell : strategy.cells) {
      invalid += cell.invalidSamples;
      const double fraction =
          cell.error.referenceVariance / atLeastItsError(cell.error.relMse).mean;
      if (fraction <= worst) continue;
      worst = fraction;
      where = fmt::format("{} at {}", strategy.name, cell.budget.label());
    }
  if (worst > kMaxReferenceFraction)
    warnings.push_back(fmt::format(
        "The reference image is noisy: its variance is {:.0f}% of the relMSE of {}. It was "
        "subtracted, but the confidence intervals of small errors are wide; give the "
        "reference more samples.",
        100 * worst, where));
  std::ranges::copy(lightWarningsOf(study, results), std::back_inserter(warnings));
  if (invalid > 0)
    warnings.push_back(
        fmt::format("{:.0f} invalid samples (NaN, infinite or negative) were ignored.", invalid));
  return warnings;
}

}  // namespace

StudyResults studyResults(const Study& study, const RenderStore& store,
                          const Reference& reference) {
  StudyResults results;
  results.reference = reference;
  results.referenceErrorKnown = !reference.squaredError.empty();
  for (const std::string& name : study.shownStrategies) {
    StrategyResult& strategy = results.strategies.emplace_back();
    strategy.name = name;
    for (const Budget& budget : study.shownBudgets) {
      std::vector<StoredRender> renders = loadRepeats(store, name, budget);
      if (renders.empty()) continue;
      strategy.unbiased = renders.front().unbiased;
      strategy.cells.push_back(cellOf(name, budget, std::move(renders), reference));
    }
    fitConvergence(strategy);
    for (const Cell& cell : strategy.cells)
      results.referenceNoise = std::sqrt(cell.error.referenceVariance);
  }
  results.complete = isComplete(study, results);
  results.baseline = study.baseline.empty() ? bestBaseline(study, results) : study.baseline;
  compareWithBaseline(results);
  results.pairs = comparePairs(study, store, results);
  results.warnings = warningsOf(study, results);
  return results;
}

RatioEstimate relativeEfficiency(const Cell& cell, const Cell& other) {
  if (&cell == &other) return {1, 0};
  return ratio(atLeastItsError(other.error.relMse), atLeastItsError(cell.error.relMse)) *
         pairedRatio(other.repeatSeconds, cell.repeatSeconds);
}

const Cell* findCell(const StrategyResult& strategy, const Budget& budget) {
  for (const Cell& cell : strategy.cells)
    if (cell.budget == budget) return &cell;
  return nullptr;
}

std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results,
                                          bool (*isWanted)(const Budget&)) {
  const auto has = [&](const std::string& name, const Budget& budget) {
    return std::ranges::any_of(results.strategies, [&](const StrategyResult& s) {
      return s.name == name && findCell(s, budget);
    });
  };
  const auto& budgets = study.shownBudgets;  // ascending
  const auto found = std::find_if(budgets.rbegin(), budgets.rend(), [&](const Budget& budget) {
    return isWanted(budget) && std::ranges::all_of(study.strategies, [&](const std::string& name) {
             return has(name, budget);
           });
  });
  return found == budgets.rend() ? std::nullopt : std::optional(*found);
}

std::optional<Budget> largestCommonBudget(const Study& study, const StudyResults& results) {
  return largestCommonBudget(study, results, [](const Budget&) { return true; });
}

}  // namespace chromeball
