// SPDX-License-Identifier: Apache-2.0
#include "study/estimate_text.h"

#include <fmt/format.h>

#include <cmath>

namespace chromeball {
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

}  // namespace chromeball
