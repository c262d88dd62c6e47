// SPDX-License-Identifier: Apache-2.0
#include "measure/noise_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "measure/false_color.h"

namespace chromeball {
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
