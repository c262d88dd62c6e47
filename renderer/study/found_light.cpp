// SPDX-License-Identifier: Apache-2.0
#include "study/results.h"

#include <fmt/format.h>

#include "study/result_tables.h"

namespace chromeball {
namespace {

// By chance a mean is as many standard errors too low in one of 30,000 comparisons.
constexpr double kSignificant = 4;
// Less light, of the reference's mean, is not missed: rounding, and a slight underestimate that the
// skew of the noise makes.
constexpr double kMinMissing = 0.01;

bool isTooDark(const Estimate& bias) {
  return bias.mean < -kMinMissing && bias.mean < -kSignificant * bias.standardError;
}

std::string missedWarning(const std::vector<std::string>& names,
                          const std::vector<std::string>& shares, bool referenceIsGiven) {
  return fmt::format(
      "The samples of {} have not found light that the reference has ({} of it), such as a small "
      "sun{}: errors, bias and verdict of such rows mean nothing. Give more samples or repeats.",
      fmt::join(names, ", "), fmt::join(shares, ", "),
      referenceIsGiven ? ", unless the reference is of another scene" : "");
}

std::string fewWarning(const std::vector<std::string>& names) {
  return fmt::format(
      "Single bright samples may make up most of the error of {}: bias, efficiency and verdict "
      "are then those of a few repeats. Give more samples or repeats.",
      fmt::join(names, ", "));
}

}  // namespace

FoundLight foundLight(const BiasVariance& error, bool unbiased) {
  if (unbiased && isTooDark(error.bias)) return FoundLight::Missed;
  return error.relMse.high() < kMaxNoiseOfPairs ? FoundLight::All : FoundLight::Few;
}

std::vector<std::string> lightWarnings(std::span<const LightOfRow> rows, bool referenceIsGiven) {
  std::vector<std::string> missed, shares, few, warnings;
  for (const LightOfRow& row : rows) {
    if (row.light == FoundLight::Few) few.push_back(row.name);
    if (row.light != FoundLight::Missed) continue;
    missed.push_back(row.name);
    shares.push_back(shortNumber(100 * row.bias, 2) + "%");
  }
  if (!missed.empty()) warnings.push_back(missedWarning(missed, shares, referenceIsGiven));
  if (!few.empty()) warnings.push_back(fewWarning(few));
  return warnings;
}

}  // namespace chromeball
