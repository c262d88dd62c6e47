// SPDX-License-Identifier: Apache-2.0
#include "film/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chromeball {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kReach = 3;        // windows are 7 x 7 pixels
constexpr double kKnown = 0.25;  // relative error of a luminance that counts as known

// Calls visit(j) for the pixels of the window around (x, y), itself included.
template <class Visit>
void forWindow(int width, int height, int x, int y, const Visit& visit) {
  for (int v = std::max(0, y - kReach); v <= std::min(height - 1, y + kReach); ++v)
    for (int u = std::max(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u)
      visit(size_t(v) * size_t(width) + size_t(u));
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / double(std::max<size_t>(values.size(), 1));
}

// What a pixel's error is compared with: its luminance, and at least a hundredth of the picture's.
// Where the pixel's own samples leave its luminance open, as a firefly does, that of the window:
// else the error of rare light would be divided by the luminance of those few pixels that met it.
double referenceLuminance(const PixelErrors& errors, int x, int y, double mean) {
  const size_t i = size_t(y) * size_t(errors.width) + size_t(x);
  double reference = errors.luminances[i];
  if (errors.halves[i].w > kKnown * kKnown * reference * reference) {
    double sum = 0, count = 0;
    forWindow(errors.width, errors.height, x, y,
              [&](size_t j) { sum += errors.luminances[j], ++count; });
    reference = std::min(reference, sum / count);
  }
  return std::max(reference, 0.01 * mean);
}

// Which part of the mean of a window's rare light a pixel takes at least: nothing where its pixels
// scatter alike, all where a few of them hold most of the scatter. `concentration` is 1 where all
// scatter alike, and the number of pixels where one does it all.
double fractionOfMean(double concentration) {
  constexpr double kEven = 4, kRare = 8;  // an edge between noise and none gives 2
  return std::clamp((concentration - kEven) / (kRare - kEven), 0.0, 1.0);
}

// Whether most of what the pixel shows comes from a few of its samples. (Of an edge between bright
// and dark all samples tell.)
bool hasMetRareLight(const PixelErrors& e, size_t j) {
  return e.scatter[j].w > kKnown * kKnown * e.luminances[j] * e.luminances[j];
}

// Of a pixel of which something is known. `logScatter`: binary logarithms of the luminances'
// scatter.
glm::dvec4 squaredStandardError(const PixelErrors& e, const std::vector<double>& logScatter, int x,
                                int y) {
  const size_t i = size_t(y) * size_t(e.width) + size_t(x);
  glm::dvec4 ratio(0), weight(0), rareHalves(0);
  double rareScatter = 0, rareSquared = 0, count = 0;
  forWindow(e.width, e.height, x, y, [&](size_t j) {
    if (std::isnan(e.halves[j].w)) return;
    ++count;
    if (hasMetRareLight(e, j)) {
      rareHalves += e.halves[j];
      rareScatter += e.scatter[j].w;
      rareSquared += e.scatter[j].w * e.scatter[j].w;
    }
    const double apart = logScatter[j] - logScatter[i], alike = 1 / (1 + apart * apart);
    if (!(alike > 0)) return;  // one of the two does not scatter
    for (int c = 0; c < 4; ++c)
      if (e.scatter[j][c] > 0) {
        ratio[c] += alike * e.halves[j][c] / e.scatter[j][c];
        weight[c] += alike;
      }
  });
  double minimum = 0;
  if (e.scatter[i].w > 0 && rareScatter > 0)
    minimum = fractionOfMean(count * rareSquared / (rareScatter * rareScatter));
  glm::dvec4 squared;
  for (int c = 0; c < 4; ++c) {
    const double own = e.scatter[i][c] * (weight[c] > 0 ? ratio[c] / weight[c] : 1);
    squared[c] = std::max(own, minimum * rareHalves[c] / count);
  }
  return squared;
}

}  // namespace

void PixelErrors::add(const PixelErrors& other) {
  for (size_t i = 0; i < halves.size(); ++i) {
    halves[i] += other.halves[i];
    scatter[i] += other.scatter[i];
  }
}

std::vector<glm::dvec4> squaredStandardErrors(const PixelErrors& e) {
  std::vector<double> logScatter(e.scatter.size());
  for (size_t i = 0; i < logScatter.size(); ++i) logScatter[i] = std::log2(e.scatter[i].w);

  std::vector<glm::dvec4> squared(e.halves.size(), glm::dvec4(kNan));
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const size_t i = size_t(y) * size_t(e.width) + size_t(x);
      if (!std::isnan(e.halves[i].w)) squared[i] = squaredStandardError(e, logScatter, x, y);
    }
  return squared;
}

Image varianceImage(const std::vector<glm::dvec4>& squaredErrors, int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.setRgb(x, y, Rgb(squaredErrors[size_t(y) * size_t(width) + size_t(x)]));
  return image;
}

Noise estimateNoise(const PixelErrors& errors) {
  const double mean = meanOf(errors.luminances);
  if (!(mean > 0)) return {kNan, kNan};
  double sum = 0, sumOfSquares = 0, count = 0;
  for (int y = 0; y < errors.height; ++y)
    for (int x = 0; x < errors.width; ++x) {
      const double squared = errors.halves[size_t(y) * size_t(errors.width) + size_t(x)].w;
      if (std::isnan(squared)) continue;
      const double reference = referenceLuminance(errors, x, y, mean);
      const double relative = squared / reference / reference;
      sum += relative;
      sumOfSquares += relative * relative;
      ++count;
    }
  if (count == 0) return {kNan, kNan};
  const double average = sum / count;
  const double variance = std::max(sumOfSquares / count - average * average, 0.0);
  return {std::sqrt(average), std::sqrt(average + 1.96 * std::sqrt(variance / count))};
}

NoiseQuantiles noiseQuantiles(const PixelErrors& errors,
                              const std::vector<glm::dvec4>& squaredErrors) {
  const double floor = 0.01 * meanOf(errors.luminances);
  std::vector<double> relative;
  for (size_t i = 0; i < squaredErrors.size(); ++i)
    if (!std::isnan(squaredErrors[i].w))
      relative.push_back(std::sqrt(squaredErrors[i].w) / std::max(errors.luminances[i], floor));
  if (relative.empty() || !(floor > 0)) return {kNan, kNan};
  const auto quantile = [&](double fraction) {
    const auto at = relative.begin() + std::ptrdiff_t(fraction * double(relative.size() - 1));
    std::nth_element(relative.begin(), at, relative.end());
    return *at;
  };
  return {quantile(0.5), quantile(0.95)};
}

}  // namespace chromeball
