// SPDX-License-Identifier: Apache-2.0
#include "image/auto_exposure.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

constexpr double kMean = 0.25;
constexpr double kOutliers = 0.02;  // at either end
constexpr double kClipped = 0.05;

struct Levels {
  std::vector<float> luminances, largest;  // of the pixels, in ascending order
};

Levels levelsOf(const Image& radiance, const Image* coverage) {
  Levels levels;
  for (size_t i = 0; i < radiance.pixels(); ++i) {
    const Rgb c = radiance.channels < 3 ? Rgb(*radiance.at(i)) : radiance.rgb(i);
    const float y = luminance(c);
    if (!(y > 0) || !std::isfinite(y) || (coverage && !(*coverage->at(i) >= 0.5f))) continue;
    levels.luminances.push_back(y);
    levels.largest.push_back(maxComponent(c));
  }
  std::ranges::sort(levels.luminances);
  std::ranges::sort(levels.largest);
  return levels;
}

}  // namespace

float autoExposure(const Image& radiance, const Image& coverage) {
  Levels levels = coverage.empty() ? Levels() : levelsOf(radiance, &coverage);
  if (levels.luminances.empty()) levels = levelsOf(radiance, nullptr);
  if (levels.luminances.empty()) return 0;
  const size_t count = levels.luminances.size(), outliers = size_t(kOutliers * double(count));
  double sum = 0;
  for (size_t i = outliers; i < count - outliers; ++i)
    sum += std::log2(double(levels.luminances[i]));
  const double toMean = std::log2(kMean) - sum / double(count - 2 * outliers);
  const size_t bright = size_t(double(count - 1) * (1 - kClipped));
  const double toWhite = -std::log2(double(levels.largest[bright]));
  return float(std::round(10 * std::min(toMean, toWhite)) / 10) + 0.0f;  // never -0
}

}  // namespace chromeball
