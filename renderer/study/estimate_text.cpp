// SPDX-License-Identifier: Apache-2.0
#include "study/estimate_text.h"

#include <fmt/format.h>

#include <cmath>

namespace chromeball {
namespace {

constexpr double kLargestPlain = 1e7, kSmallestPlain = 1e-4;

// `x` to a multiple of 10^place, as a multiple of 10^exponent.
std::string toPlace(double x, int location, int exponent) {
  const double unit = std::pow(10.0, location), rounded = std::round(x / unit) * unit + 0.0;
  const std::string digits =
      fmt::format("{:.{}f}", rounded / std::pow(10.0, exponent), std::max(0, exponent - location));
  return exponent ? fmt::format("{}e{}", digits, exponent) : digits;
}

}  // namespace

EstimateText estimateText(const Estimate& e) {
  const double half = 1.96 * e.standardError;
  if (!std::isfinite(e.mean) || !std::isfinite(half)) return {"unknown", "unknown", false};
  if (half == 0) return {shortNumber(e.mean), "0", e.mean != 0};
  const auto exponentOf = [](double x) { return int(std::floor(std::log10(x))); };
  const bool startsWithOne = half < 1.95 * std::pow(10.0, exponentOf(half));
  const int location = exponentOf(half) - (startsWithOne ? 1 : 0);
  const double size = std::max(std::fabs(e.mean), half);
  const bool isPlain = size < kLargestPlain && size >= kSmallestPlain;
  const int exponent = isPlain ? 0 : exponentOf(size);
  return {toPlace(e.mean, location, exponent), toPlace(half, location, exponent),
          std::fabs(e.mean) > half};
}

std::string resolvedText(const Estimate& e) {
  const EstimateText text = estimateText(e);
  if (text.number == "unknown") return "not known";
  if (!text.isResolved) return fmt::format("not resolved (+- {})", text.halfInterval);
  if (e.standardError == 0) return text.number;
  return fmt::format("{} +- {}", text.number, text.halfInterval);
}

std::string shortNumber(double x, int digits) {
  const double size = std::fabs(x);
  if (size >= std::pow(10, digits) && size < kLargestPlain) return fmt::format("{:.0f}", x);
  return fmt::format("{:.{}g}", x, digits);
}

}  // namespace chromeball
