// SPDX-License-Identifier: Apache-2.0
#include "measure/false_color.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

template <size_t N>
Color8 interpolate(const std::array<Color8, N>& anchors, double t) {
  const double position = std::clamp(std::isnan(t) ? 0 : t, 0.0, 1.0) * double(N - 1);
  const size_t below = std::min(size_t(position), N - 2);
  const double fraction = position - double(below);
  Color8 color;
  for (size_t c = 0; c < 3; ++c)
    color[c] =
        uint8_t(std::lround((1 - fraction) * anchors[below][c] + fraction * anchors[below + 1][c]));
  return color;
}

}  // namespace

Color8 heatColor(double t) {
  static constexpr std::array<Color8, 8> kAnchors = {{{0, 0, 4},
                                                      {40, 11, 84},
                                                      {101, 21, 110},
                                                      {159, 42, 99},
                                                      {212, 72, 66},
                                                      {245, 125, 21},
                                                      {250, 193, 39},
                                                      {252, 255, 164}}};
  return interpolate(kAnchors, t);
}

Color8 signedColor(double t) {
  static constexpr std::array<Color8, 5> kAnchors = {
      {{33, 102, 172}, {146, 197, 222}, {247, 247, 247}, {244, 165, 130}, {178, 24, 43}}};
  return interpolate(kAnchors, (t + 1) / 2);
}

double logLevel(double number, double maximum, double decades) {
  if (!(number > 0)) return 0;
  return std::clamp(1 + std::log10(number / maximum) / decades, 0.0, 1.0);
}

double roundUp(double number) {
  if (!(number > 0) || !std::isfinite(number)) return 1;
  const double decade = std::pow(10, std::floor(std::log10(number)));
  for (const double step : {1.0, 2.0, 5.0})
    if (number <= step * decade) return step * decade;
  return 10 * decade;
}

double percentile(std::vector<float> numbers, double fraction) {
  std::erase_if(numbers, [](float x) { return std::isnan(x); });
  if (numbers.empty()) return 0;
  const auto nth = numbers.begin() + std::ptrdiff_t(fraction * double(numbers.size() - 1));
  std::nth_element(numbers.begin(), nth, numbers.end());
  return *nth;
}

}  // namespace chromeball
