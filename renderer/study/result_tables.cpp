// SPDX-License-Identifier: Apache-2.0
#include "study/result_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "base/json_text.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity and no NaN; these become null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json toJson(const Estimate& e) {
  return {{"mean", number(e.mean)}, {"low", number(e.low())}, {"high", number(e.high())}};
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
  csv += ",prepare_seconds,mse,reference_variance,reported_noise,invalid_samples\n";
  for (const StrategyResult& strategy : results.strategies)
    for (const Cell& cell : strategy.cells) {
      const BiasVariance& error = cell.error;
      csv += fmt::format("{},{},{},{}", strategy.name, strategy.unbiased ? "yes" : "no",
                         cell.budget.label(), cell.samples);
      for (const Estimate& e : {cell.seconds, error.relMse, error.variance, error.squaredBias,
                                error.bias, cell.efficiency})
        csv += fmt::format(",{:.6g},{:.6g},{:.6g}", e.mean, e.low(), e.high());
      csv += fmt::format(",{:.4g},{:.6g},{:.6g},{:.6g},{:g}\n", cell.prepareSeconds, error.mse,
                         error.referenceVariance, cell.noise, cell.invalidSamples);
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
               {"baseline", study.baseline},
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
  std::ranges::stable_sort(cells, std::ranges::greater(),
                           [](const Cell* cell) { return cell->efficiency.mean; });
  return cells;
}

std::string resultsTable(const Study& study, const StudyResults& results) {
  const std::vector<const Cell*> cells = ranking(study, results);
  if (cells.empty()) return "no budget has been rendered with all strategies\n";
  std::string table =
      fmt::format("{:<26} {:>22} {:>18} {:>24} {:>22}   (at {})\n", "strategy", "efficiency",
                  "seconds", "relMSE", "bias %", cells.front()->budget.label());
  for (const Cell* cell : cells) {
    const Estimate& bias = cell->error.bias;
    table += fmt::format("{:<26} {:>22} {:>18} {:>24} {:>22}\n", cell->strategy,
                         significantText(cell->efficiency), significantText(cell->seconds),
                         significantText(cell->error.relMse),
                         significantText({100 * bias.mean, 100 * bias.standardError}));
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

std::string shortNumber(double x, int digits) {
  const double size = std::fabs(x);
  if (size >= std::pow(10, digits) && size < kMaxPlain) return fmt::format("{:.0f}", x);
  return fmt::format("{:.{}g}", x, digits);
}

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
  std::ranges::stable_sort(sorted, {}, [](const Contender& c) { return c.cost.mean; });
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
  std::string sentence =
      fmt::format("{} is biased: a relMSE of {} +- {} remains with any number of samples",
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
  const auto add = [&](const Budget& budget, Estimate (*cost)(const Cell&), const char* condition,
                       const char* metric) {
    sentences.push_back(winner(contenders(results, budget, cost),
                               fmt::format("{}{})", condition, budget.label()), metric,
                               study.baseline));
  };
  if (samples) add(*samples, relMse, "At equal samples (", "relMSE");
  if (seconds)
    add(*seconds, relMse, "At equal time (", "relMSE");
  else if (samples)
    add(*samples, relMseTimesSeconds, "At equal time (extrapolated from ", "relMSE x seconds");
  for (const StrategyResult& strategy : results.strategies)
    if (!strategy.unbiased)
      if (std::string text = biasOf(strategy, results.referenceErrorKnown); !text.empty())
        sentences.push_back(std::move(text));
  return sentences;
}

}  // namespace chromeball
