// SPDX-License-Identifier: Apache-2.0
#include "measure/false_color.h"

#include <algorithm>
#include <array>
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

namespace {

constexpr double kWorst = 0.05;  // of the pixels

// Columns and rows of a 3 x 3 grid.
struct Part {
  std::string_view name;
  int left, top, right, bottom;
};

// From small to large.
constexpr std::array kParts = {
    Part{"upper left", 0, 0, 1, 1},
    Part{"top", 1, 0, 2, 1},
    Part{"upper right", 2, 0, 3, 1},
    Part{"left", 0, 1, 1, 2},
    Part{"middle", 1, 1, 2, 2},
    Part{"right", 2, 1, 3, 2},
    Part{"lower left", 0, 2, 1, 3},
    Part{"bottom", 1, 2, 2, 3},
    Part{"lower right", 2, 2, 3, 3},
    Part{"upper third", 0, 0, 3, 1},
    Part{"middle, from left to right", 0, 1, 3, 2},
    Part{"lower third", 0, 2, 3, 3},
    Part{"left third", 0, 0, 1, 3},
    Part{"middle, from top to bottom", 1, 0, 2, 3},
    Part{"right third", 2, 0, 3, 3},
    Part{"upper part", 0, 0, 3, 2},
    Part{"lower part", 0, 1, 3, 3},
    Part{"left part", 0, 0, 2, 3},
    Part{"right part", 1, 0, 3, 3},
};

}  // namespace

std::string_view noisiestPart(const Image& relativeErrors) {
  constexpr double kMost = 0.6, kExcess = 0.2;  // of the worst pixels; beyond the part's area
  const Image& e = relativeErrors;
  const double limit = percentile(e.texels, 1 - kWorst);
  std::array<std::array<double, 3>, 3> counts{};
  double all = 0;
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x)
      if (*e.at(x, y) > limit) ++counts[size_t(3 * y / e.height)][size_t(3 * x / e.width)], ++all;
  for (const Part& part : kParts) {
    double inside = 0;
    for (int y = part.top; y < part.bottom; ++y)
      for (int x = part.left; x < part.right; ++x) inside += counts[size_t(y)][size_t(x)];
    const double area = (part.right - part.left) * (part.bottom - part.top) / 9.0;
    if (inside > std::max(kMost, area + kExcess) * all) return part.name;
  }
  return "";
}

NoiseMap noiseMap(const Image& relativeErrors) {
  constexpr int kMost = 320;
  constexpr double kDecades = 3;
  constexpr Color8 kUnknown = {128, 128, 128};
  const Image& e = relativeErrors;
  const int square = (std::max(e.width, e.height) + kMost - 1) / kMost;
  NoiseMap map{(e.width + square - 1) / square, (e.height + square - 1) / square, {}};
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      double sum = 0, count = 0;
      for (int v = y * square; v < std::min((y + 1) * square, e.height); ++v)
        for (int u = x * square; u < std::min((x + 1) * square, e.width); ++u)
          if (const double error = double(*e.at(u, v)); !std::isnan(error))
            sum += error * error, ++count;
      const Color8 color =
          count > 0 ? heatColor(logLevel(std::sqrt(sum / count), 1, kDecades)) : kUnknown;
      map.bytes.insert(map.bytes.end(), color.begin(), color.end());
    }
  return map;
}

}  // namespace chromeball
