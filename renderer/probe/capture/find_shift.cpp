// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/find_shift.h"

#include <algorithm>
#include <cmath>

#include "math/cdf.h"
#include "probe/capture/exposure.h"

namespace chromeball {
namespace {

constexpr int kScales = 6;  // shifts of 2^kScales - 1 pixels

Image greenOf(const Image& image) {
  Image green(image.width, image.height, 1);
  for (size_t i = 0; i < green.texels.size(); ++i) {
    const float level = image.texels[3 * i + 1];
    green.texels[i] = level > 0 ? std::min(level, 1.0f) : 0;  // NaN is 0
  }
  return green;
}

// The fractions of the pixels that are too dark to tell apart, and that are not saturated.
struct Percentiles {
  double low, high;
};
Percentiles percentilesShown(const Image& green) {
  constexpr float kDark = 5 / 255.f;
  const auto& texels = green.texels;
  const auto dark = std::ranges::count_if(texels, [](float level) { return level <= kDark; });
  const auto shown = std::ranges::count_if(texels, [](float level) { return level < kSaturated; });
  return {double(dark) / double(texels.size()), double(shown) / double(texels.size())};
}

// Of half the size: means of 2 x 2 pixels.
Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2, 1);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x)
      *half.at(x, y) = (*image.at(2 * x, 2 * y) + *image.at(2 * x + 1, 2 * y) +
                        *image.at(2 * x, 2 * y + 1) + *image.at(2 * x + 1, 2 * y + 1)) /
                       4;
  return half;
}

// 1 above the percentile, -1 below it, 0 too close to it to tell.
struct Bitmap {
  int width, height;
  std::vector<int8_t> sides;

  Bitmap(const Image& image, double percentile)
      : width(image.width), height(image.height), sides(image.texels.size()) {
    constexpr float kTooClose = 0.04f;
    const float threshold = quantile(image.texels, percentile);
    for (size_t i = 0; i < sides.size(); ++i) {
      const float level = image.texels[i];
      sides[i] = level > (1 + kTooClose) * threshold   ? 1
                 : level < (1 - kTooClose) * threshold ? -1
                                                       : 0;
    }
  }
};

// The fraction of the pixels on different sides; 1 if none can be compared.
double mismatch(const Bitmap& a, const Bitmap& b, int dx, int dy) {
  size_t compared = 0, different = 0;
  for (int y = std::max(0, -dy); y < std::min(a.height, b.height - dy); ++y)
    for (int x = std::max(0, -dx); x < std::min(a.width, b.width - dx); ++x) {
      const int product =
          a.sides[size_t(y) * a.width + x] * b.sides[size_t(y + dy) * b.width + (x + dx)];
      compared += product != 0;
      different += product < 0;
    }
  return compared > 0 ? double(different) / double(compared) : 1;
}

Shift shiftBetween(const Image& a, const Image& b, double percentile, int scales) {
  constexpr int kLeastSide = 16;
  Shift start;
  if (scales > 1 && std::min(a.width, a.height) >= 2 * kLeastSide)
    start = shiftBetween(halved(a), halved(b), percentile, scales - 1);
  const Bitmap from(a, percentile), to(b, percentile);
  Shift best;
  best.mismatch = best.mismatchShifted = mismatch(from, to, 0, 0);
  for (int dy = 2 * start.dy - 1; dy <= 2 * start.dy + 1; ++dy)
    for (int dx = 2 * start.dx - 1; dx <= 2 * start.dx + 1; ++dx)
      if (const double found = mismatch(from, to, dx, dy); found < best.mismatchShifted)
        best.dx = dx, best.dy = dy, best.mismatchShifted = found;
  return best;
}

}  // namespace

bool Shift::isCertain() const {
  constexpr double kLeast = 0.005;
  return dx * dx + dy * dy >= 4 && mismatch > kLeast && mismatchShifted < mismatch / 2;
}

Shift findShift(const Image& from, const Image& to) {
  const Image a = greenOf(from), b = greenOf(to);
  const Percentiles shownA = percentilesShown(a), shownB = percentilesShown(b);
  const double low = std::max(shownA.low, shownB.low), high = std::min(shownA.high, shownB.high);
  return low < high ? shiftBetween(a, b, (low + high) / 2, kScales) : Shift{};
}

}  // namespace chromeball
