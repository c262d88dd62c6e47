// SPDX-License-Identifier: Apache-2.0
#include "study/result_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/json.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity and no NaN; these become null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json toJson(const Estimate& e) {
  return {{"mean", number(e.mean)}, {"low", number(e.low())}, {"high", number(e.high())}};
}

Json toJson(const RatioEstimate& r) {
  return {{"mean", number(r.value)}, {"low", number(r.low())}, {"high", number(r.high())}};
}

bool missesLight(const Cell& cell) { return cell.light == FoundLight::Missed; }

const StrategyResult& rowOf(const StudyResults& results, const Cell& cell) {
  return *std::ranges::find(results.strategies, cell.strategy, &StrategyResult::name);
}

Json toJson(const Cell& cell) {
  return {{"budget", cell.budget.label()},
          {"samples", cell.samples},
          {"seconds", toJson(cell.seconds)},
          {"prepare_seconds", cell.prepareSeconds},
          {"relmse", toJson(cell.error.relMse)},
          {"variance", toJson(cell.error.variance)},
          {"squared_bias", toJson(cell.error.squaredBias)},
          {"bias", toJson(cell.error.bias)},
          {"mse", cell.error.mse},
          {"missed_light", missesLight(cell)},
          {"efficiency", toJson(cell.efficiency)},
          {"reference_variance", cell.error.referenceVariance},
          {"reported_noise", number(cell.noise)},
          {"invalid_samples", cell.invalidSamples}};
}

Json toJson(const StrategyResult& strategy) {
  Json json = {{"name", strategy.name}, {"unbiased", strategy.unbiased}};
  json["variance_slope"] = strategy.variance ? toJson(strategy.variance->slope) : Json(nullptr);
  json["relmse_slope"] = strategy.relMse ? toJson(strategy.relMse->slope) : Json(nullptr);
  json["squared_bias"] = toJson(strategy.squaredBias);
  if (const auto& crossing = strategy.biasEqualsNoise)
    json["bias_equals_noise"] = {
        {"samples", crossing->samples}, {"low", crossing->low}, {"high", crossing->high}};
  json["cells"] = Json::array();
  for (const Cell& cell : strategy.cells) json["cells"].push_back(toJson(cell));
  return json;
}

}  // namespace

std::string resultsCsv(const StudyResults& results) {
  std::string csv = "strategy,unbiased,budget,samples";
  for (const char* name : {"seconds", "relmse", "variance", "squared_bias", "bias", "efficiency"})
    csv += fmt::format(",{0},{0}_low,{0}_high", name);
  csv += ",prepare_seconds,mse,reference_variance,reported_noise,invalid_samples,missed_light\n";
  for (const StrategyResult& strategy : results.strategies)
    for (const Cell& cell : strategy.cells) {
      const BiasVariance& error = cell.error;
      csv += fmt::format("{},{},{},{}", strategy.name, strategy.unbiased ? "yes" : "no",
                         cell.budget.label(), cell.samples);
      for (const Estimate& e :
           {cell.seconds, error.relMse, error.variance, error.squaredBias, error.bias})
        csv += fmt::format(",{:.6g},{:.6g},{:.6g}", e.mean, e.low(), e.high());
      const RatioEstimate& r = cell.efficiency;
      csv += fmt::format(",{:.6g},{:.6g},{:.6g},{:.4g},{:.6g},{:.6g},{:.6g},{:g},{}\n", r.value,
                         r.low(), r.high(), cell.prepareSeconds, error.mse, error.referenceVariance,
                         cell.noise, cell.invalidSamples, missesLight(cell) ? "yes" : "no");
    }
  return csv;
}

Json resultsJson(const Study& study, const StudyResults& results, const Machine& machine) {
  Json json = {{"version", CHROMEBALL_VERSION},
               {"command", machine.command},
               {"date", machine.date},
               {"machine",
                {{"processor", machine.processor},
                 {"system", machine.system},
                 {"compiler", machine.compiler},
                 {"threads", machine.threads}}},
               {"study", readJson(study.identity)},
               {"complete", results.complete},
               {"warnings", results.warnings},
               {"repeats", study.repeats},
               {"baseline", results.baseline},
               {"reference", {{"relative_standard_error", results.referenceNoise}}}};
  if (study.referenceFile.empty())
    json["reference"].update(
        {{"strategy", study.referenceStrategy}, {"samples", study.referenceSamples}});
  else
    json["reference"]["file"] = study.referenceFile;
  json["strategies"] = Json::array();
  for (const StrategyResult& strategy : results.strategies)
    json["strategies"].push_back(toJson(strategy));
  json["agreement"] = Json::array();
  for (const PairResult& pair : results.pairs)
    json["agreement"].push_back({{"a", pair.a},
                                 {"b", pair.b},
                                 {"budget", pair.budget.label()},
                                 {"tiles", pair.agreement.tiles},
                                 {"fraction_failing", pair.agreement.fraction},
                                 {"p_value", pair.agreement.pValue}});
  return json;
}

std::vector<const Cell*> ranking(const Study& study, const StudyResults& results) {
  std::vector<const Cell*> cells;
  const std::optional<Budget> budget = largestCommonBudget(study, results);
  for (const StrategyResult& strategy : results.strategies)
    if (const Cell* cell = budget ? findCell(strategy, *budget) : nullptr) cells.push_back(cell);
  std::ranges::stable_sort(cells, std::ranges::greater(), [](const Cell* cell) {
    if (missesLight(*cell)) return -1.0;
    return cell->efficiency.value > 0 ? cell->efficiency.value : 0;  // unknown: last of the others
  });
  return cells;
}

std::string resultsTable(const Study& study, const StudyResults& results) {
  const std::vector<const Cell*> cells = ranking(study, results);
  if (cells.empty()) return "no budget has been rendered with all strategies\n";
  std::string table =
      fmt::format("{:<26} {:>24} {:>18} {:>24} {:>24}   (at {})\n", "strategy", "efficiency",
                  "seconds", "relMSE", "bias %", cells.front()->budget.label());
  for (const Cell* cell : cells) {
    const bool isUnbiased = rowOf(results, *cell).unbiased;
    table += fmt::format("{:<26} {:>24} {:>18} {:>24} {:>24}\n",
                         cell->strategy + (isUnbiased ? "" : " (biased)"),
                         ratioText(cell->efficiency), positiveText(cell->seconds),
                         positiveText(cell->error.relMse), biasText(cell->error.bias, cell->light));
  }
  return table;
}

namespace {

// Numbers in this range are written without an exponent.
constexpr double kMinPlain = 1e-4, kMaxPlain = 1e7;

// `x` rounded to a multiple of 10^place, written as a multiple of 10^exponent.
std::string rounded(double x, int place, int exponent) {
  const double unit = std::pow(10.0, place), multiple = std::round(x / unit) * unit + 0.0;
  const std::string digits =
      fmt::format("{:.{}f}", multiple / std::pow(10.0, exponent), std::max(0, exponent - place));
  return exponent ? fmt::format("{}e{}", digits, exponent) : digits;
}

}  // namespace

EstimateText estimateText(const Estimate& e) {
  const double half = 1.96 * e.standardError;
  if (!std::isfinite(e.mean) || !std::isfinite(half)) return {"unknown", "unknown", false};
  if (half == 0) return {shortNumber(e.mean), "0", e.mean != 0};
  const auto exponentOf = [](double x) { return int(std::floor(std::log10(x))); };
  const bool startsWithOne = half < 1.95 * std::pow(10.0, exponentOf(half));
  const int place = exponentOf(half) - (startsWithOne ? 1 : 0);
  const double size = std::max(std::fabs(e.mean), half);
  const bool isPlain = size < kMaxPlain && size >= kMinPlain;
  const int exponent = isPlain ? 0 : exponentOf(size);
  return {rounded(e.mean, place, exponent), rounded(half, place, exponent),
          std::fabs(e.mean) > half};
}

std::string significantText(const Estimate& e) {
  const EstimateText text = estimateText(e);
  if (text.number == "unknown") return "unknown";
  if (!text.isSignificant) return fmt::format("not significant (+- {})", text.halfInterval);
  if (e.standardError == 0) return text.number;
  return fmt::format("{} +- {}", text.number, text.halfInterval);
}

std::string positiveText(const Estimate& e) {
  if (estimateText(e).isSignificant || !(e.mean >= e.standardError)) return significantText(e);
  return ratioText({e.mean, e.standardError / e.mean});
}

std::string biasText(const Estimate& bias, FoundLight light) {
  const Estimate percent{100 * bias.mean, 100 * bias.standardError};
  if (light != FoundLight::Missed) return significantText(percent);
  return estimateText(percent).number + " (light not found)";
}

std::string ratioText(const RatioEstimate& r) {
  if (!std::isfinite(r.value) || !std::isfinite(r.high())) return "unknown";
  if (r.logError == 0) return shortNumber(r.value);
  const int digits = 1.96 * r.logError < 0.2 ? 3 : 2;
  const auto text = [&](double x) {
    const double unit = std::pow(10.0, std::floor(std::log10(x)) + 1 - digits);
    return shortNumber(std::round(x / unit) * unit, digits);
  };
  return fmt::format("{} ({} to {})", text(r.value), text(r.low()), text(r.high()));
}

std::string shortNumber(double x, int digits) {
  const double size = std::fabs(x);
  if (size >= std::pow(10, digits) && size < kMaxPlain) return fmt::format("{:.0f}", x);
  return fmt::format("{:.{}g}", x, digits);
}

namespace {

using Cells = std::vector<const Cell*>;

// "a", "a or b", "a, b or c".
std::string alternatives(const std::vector<std::string>& names) {
  const auto last = names.end() - 1;
  if (names.size() == 1) return *last;
  return fmt::format("{} or {}", fmt::join(names.begin(), last, ", "), *last);
}

// "the next best": of all cells, the most efficient first, or only of the unbiased, which `cells`
// then are, where another one is before it.
std::string nextBest(const Cell* next, const Cells& cells, const Cells& all) {
  const auto isOther = [&](const Cell* cell) { return std::ranges::count(cells, cell) == 0; };
  const bool follows = std::any_of(all.begin(), std::ranges::find(all, next), isOther);
  return follows ? "the next best of the unbiased" : "the next best";
}

// Which of these cells, the most efficient first, to use: the first and those that do not differ
// from it significantly; and how far the next one is behind.
std::string recommendation(const Cells& cells, const Cells& all) {
  const Cell& best = *cells.front();
  std::vector<std::string> names{best.strategy};
  std::string next;
  for (const Cell* cell : std::span(cells).subspan(1)) {
    const RatioEstimate lead = relativeEfficiency(best, *cell);
    if (!(lead.low() > 1))
      names.push_back(cell->strategy);
    else if (next.empty())
      next = fmt::format("{}, {}, has {} times the relMSE of {}", cell->strategy,
                         nextBest(cell, cells, all), ratioText(lead), best.strategy);
  }
  std::string sentence = fmt::format("Use {}", alternatives(names));
  if (names.size() > 1) sentence += ": no significant difference between them at equal time";
  if (!next.empty()) sentence += (names.size() > 1 ? "; " : ": at equal time ") + next;
  return sentence + ".";
}

// Which of the biased cells are better than the best unbiased one, and up to where.
std::string biasedLine(const StudyResults& results, const Cells& biased, const Cell& best) {
  std::vector<std::string> better;
  for (const Cell* cell : biased) {
    const RatioEstimate lead = relativeEfficiency(*cell, best);
    if (!(lead.low() > 1)) continue;
    const auto& crossing = rowOf(results, *cell).biasEqualsNoise;
    better.push_back(fmt::format(
        "{} by {}{}", cell->strategy, ratioText(lead),
        crossing ? fmt::format(" until its bias equals its noise at {} samples per pixel",
                               shortNumber(crossing->samples, 2))
                 : ""));
  }
  if (better.empty())
    return fmt::format("Of {} biased, none is significantly better at equal time.", biased.size());
  return fmt::format("Of {} biased, better at equal time: {}.", biased.size(),
                     fmt::join(better, ", "));
}

}  // namespace

std::vector<std::string> verdict(const Study& study, const StudyResults& results) {
  Cells unbiased, biased, missed;
  const Cells all = ranking(study, results);
  for (const Cell* cell : all)
    if (missesLight(*cell))
      missed.push_back(cell);
    else
      (rowOf(results, *cell).unbiased ? unbiased : biased).push_back(cell);
  std::vector<std::string> sentences;
  if (unbiased.empty() && !biased.empty())
    sentences = {recommendation(biased, all), "All of them are biased."};
  if (unbiased.empty() && !missed.empty())
    sentences.push_back(
        fmt::format("{} has found all light that the reference has: give more samples or repeats.",
                    biased.empty() ? "None" : "None of the unbiased"));
  if (!unbiased.empty()) sentences.push_back(recommendation(unbiased, all));
  if (!unbiased.empty() && !biased.empty())
    sentences.push_back(biasedLine(results, biased, *unbiased.front()));
  return sentences;
}

}  // namespace chromeball
