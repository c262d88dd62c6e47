// SPDX-License-Identifier: Apache-2.0
#include "film/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/hash.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "film/rows.h"

namespace chromeball {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr int kReach = 3;  // windows are 7 x 7 pixels
constexpr size_t kWindow = (2 * kReach + 1) * (2 * kReach + 1);
constexpr double kMaxRelativeError = 0.25;  // of a luminance that is used as a reference

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / double(std::max<size_t>(values.size(), 1));
}

// The divisor of a pixel's relative error: its luminance, and at least 0.01 of the image's mean. A
// firefly must not be divided by its own luminance, which would make its error seem small; a
// highlight must. They differ in the number of samples that make up the pixel's excess over its
// surroundings: one that alone adds d to the mean has the scatter d^2, and n equal ones have
// (n d)^2 / n. Up to three, the light is as rare as it is in the window around the pixel,
// or, at the border of a highlight, in the pixels next to it; from five on it is the
// pixel's own.
double referenceLuminance(const PixelErrors& errors, int x, int y, double mean) {
  const size_t i = size_t(y) * size_t(errors.width) + size_t(x);
  const double own = errors.luminances[i], scatter = errors.scatter[i].w;
  double reference = own;
  if (scatter > kMaxRelativeError * kMaxRelativeError * own * own) {
    double sum = 0, count = 0, nextSum = 0, nextCount = 0;
    forWindow(errors.width, errors.height, x, y, kReach, [&](size_t j, int dx, int dy) {
      sum += errors.luminances[j], ++count;
      const bool isNext = std::max(std::abs(dx), std::abs(dy)) == 1;
      if (isNext) nextSum += errors.luminances[j], ++nextCount;
    });
    const double around = std::min(own, std::max(sum / count, nextSum / std::max(nextCount, 1.0)));
    const double samples = (own - around) * (own - around) / scatter;
    reference = glm::mix(around, own, std::clamp((samples - 3) / 2, 0.0, 1.0));
  }
  return std::max(reference, 0.01 * mean);
}

// The fraction of the window's mean error from outliers that is a lower bound for each pixel: 0 if
// the scatter is even over the window, 1 if a few pixels hold most of it. `concentration` =
// n sum(s^2) / sum(s)^2 is 1 for even scatter, and n if one of n pixels has all of it.
double outlierFraction(double concentration) {
  constexpr double kEven = 4, kRare = 8;  // an edge between noise and none gives 2
  return std::clamp((concentration - kEven) / (kRare - kEven), 0.0, 1.0);
}

// Whether a few samples dominate the pixel's mean. (False for a pixel on an edge between bright and
// dark, where all samples contribute.)
bool hasOutliers(const PixelErrors& e, size_t j) {
  return e.scatter[j].w > kMaxRelativeError * kMaxRelativeError * e.luminances[j] * e.luminances[j];
}

// The pixel must have an estimate. `logScatter`: binary logarithms of the luminances' scatter.
glm::dvec4 squaredStandardError(const PixelErrors& e, const std::vector<double>& logScatter, int x,
                                int y) {
  const size_t i = size_t(y) * size_t(e.width) + size_t(x);
  glm::dvec4 ratio(0), weight(0), outlierHalves(0);
  double outlierScatter = 0, outlierSquares = 0, count = 0;
  forWindow(e.width, e.height, x, y, kReach, [&](size_t j, int, int) {
    if (std::isnan(e.halves[j].w)) return;
    ++count;
    if (hasOutliers(e, j)) {
      outlierHalves += e.halves[j];
      outlierScatter += e.scatter[j].w;
      outlierSquares += e.scatter[j].w * e.scatter[j].w;
    }
    const double logRatio = logScatter[j] - logScatter[i];
    const double similarity = 1 / (1 + logRatio * logRatio);
    if (!(similarity > 0)) return;  // the scatter of one of the two pixels is 0
    for (int c = 0; c < 4; ++c)
      if (e.scatter[j][c] > 0) {
        ratio[c] += similarity * e.halves[j][c] / e.scatter[j][c];
        weight[c] += similarity;
      }
  });
  double minFraction = 0;
  if (e.scatter[i].w > 0 && outlierScatter > 0)
    minFraction = outlierFraction(count * outlierSquares / (outlierScatter * outlierScatter));
  glm::dvec4 squared;
  for (int c = 0; c < 4; ++c) {
    const double own = e.scatter[i][c] * (weight[c] > 0 ? ratio[c] / weight[c] : 1);
    squared[c] = std::max(own, minFraction * outlierHalves[c] / count);
  }
  return squared;
}

constexpr int kAllocationReach = 2;  // windows are 5 x 5 pixels, without the one in the middle
constexpr float kMaxRate = 64;       // keeps the work of a tile bounded
constexpr double kMaxCount = 4e9;    // of a pixel
constexpr uint64_t kPixelsPerMeter = 256;  // one of so many measures the exposure

// Gaussian with a standard deviation of one pixel.
double windowWeight(int dx, int dy) {
  constexpr double kWeights[kAllocationReach + 1] = {1, 0.606531, 0.135335};
  return kWeights[std::abs(dx)] * kWeights[std::abs(dy)];
}

template <class Visit>
void forNeighbors(const PixelErrors& image, int x, int y, const Visit& visit) {
  forWindow(image.width, image.height, x, y, kAllocationReach, [&](size_t j, int dx, int dy) {
    if (dx != 0 || dy != 0) visit(j, dx, dy);
  });
}

// A metering pixel always takes the mean number of samples. It may therefore influence all others.
bool isMeter(size_t pixel) { return hash(pixel, 0x6d65746572) % kPixelsPerMeter == 0; }

double exposure(const std::vector<double>& luminances) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < luminances.size(); ++i)
    if (isMeter(i)) sum += luminances[i], ++count;
  return count > 0 ? sum / count : 0;
}

// Relative variances of the pixels, as `noise` defines them (film/noise.h); 0 where unknown. Images
// to be subtracted have negative luminances.
std::vector<double> relativeVariances(const PixelErrors& pilot) {
  const double minLuminance = 0.01 * std::fabs(exposure(pilot.luminances));
  std::vector<double> relative(pilot.luminances.size(), 0.0);
  for (size_t i = 0; i < relative.size(); ++i) {
    const double reference = std::max(std::fabs(pilot.luminances[i]), minLuminance);
    const double squared = pilot.scatter[i].w / (reference * reference);
    if (std::isfinite(squared)) relative[i] = squared;
  }
  return relative;
}

}  // namespace

void PixelErrors::add(const PixelErrors& other) {
  for (size_t i = 0; i < halves.size(); ++i) {
    halves[i] += other.halves[i];
    scatter[i] += other.scatter[i];
  }
}

std::vector<glm::dvec4> squaredStandardErrors(const PixelErrors& e) {
  auto logScatter = longArray<double>(e.scatter.size());
  forRanges(logScatter.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) logScatter[i] = std::log2(e.scatter[i].w);
  });
  auto squared = longArray<glm::dvec4>(e.halves.size());
  forRows(e.width, e.height, kWindow, [&](int y) {
    for (int x = 0; x < e.width; ++x) {
      const size_t i = size_t(y) * size_t(e.width) + size_t(x);
      const bool isKnown = !std::isnan(e.halves[i].w);
      squared[i] = isKnown ? squaredStandardError(e, logScatter, x, y) : glm::dvec4(kNan);
    }
  });
  return squared;
}

Image varianceImage(const std::vector<glm::dvec4>& squaredErrors, int width, int height) {
  Image image(width, height, 3);
  for (size_t i = 0; i < squaredErrors.size(); ++i) image.setRgb(i, Rgb(squaredErrors[i]));
  return image;
}

Noise estimateNoise(const PixelErrors& errors) {
  const double mean = meanOf(errors.luminances);
  if (!(mean > 0)) return {kNan, kNan};
  struct Sums {
    double first = 0, second = 0, count = 0;
  };
  std::vector<Sums> rows(size_t(errors.height));  // so that the result does not depend on threads
  forRows(errors.width, errors.height, kWindow, [&](int y) {
    Sums& row = rows[size_t(y)];
    for (int x = 0; x < errors.width; ++x) {
      const double squared = errors.halves[size_t(y) * size_t(errors.width) + size_t(x)].w;
      if (std::isnan(squared)) continue;
      const double reference = referenceLuminance(errors, x, y, mean);
      const double relative = squared / reference / reference;
      row.first += relative;
      row.second += relative * relative;
      ++row.count;
    }
  });
  double sum = 0, sumOfSquares = 0, count = 0;
  for (const Sums& row : rows) sum += row.first, sumOfSquares += row.second, count += row.count;
  if (count == 0) return {kNan, kNan};
  const double average = sum / count;
  const double variance = std::max(sumOfSquares / count - average * average, 0.0);
  return {std::sqrt(average), std::sqrt(average + 1.96 * std::sqrt(variance / count))};
}

Image relativeErrors(const PixelErrors& errors, const std::vector<glm::dvec4>& squaredErrors) {
  const double floor = 0.01 * meanOf(errors.luminances);
  Image relative(errors.width, errors.height, 1);
  for (size_t i = 0; i < squaredErrors.size(); ++i) {
    const double error = std::sqrt(squaredErrors[i].w);
    const double reference = std::max({errors.luminances[i], error, floor});
    relative.texels[i] = float(floor > 0 && !std::isnan(error) ? error / reference : kNan);
  }
  return relative;
}

NoiseQuantiles noiseQuantiles(const Image& relativeErrors) {
  std::vector<float> known = relativeErrors.texels;
  std::erase_if(known, [](float error) { return std::isnan(error); });
  if (known.empty()) return {kNan, kNan};
  constexpr float kClean = 0.002f;
  const bool isNoisy = std::ranges::any_of(known, [](float error) { return error > kClean; });
  std::erase_if(known, [&](float error) { return !(error > (isNoisy ? kClean : 0)); });
  if (known.empty()) return {0, 0};
  const auto quantile = [&](double fraction) {
    const auto at = known.begin() + std::ptrdiff_t(fraction * double(known.size() - 1));
    std::nth_element(known.begin(), at, known.end());
    return double(*at);
  };
  return {quantile(0.5), quantile(0.95)};
}

SampleAllocation::SampleAllocation(const PixelErrors& pilot, uint32_t pilotSamples, float leastRate)
    : width_(pilot.width), pilotSamples_(pilotSamples), rates_(pilot.luminances.size(), 1.0f) {
  const std::vector<double> relative = relativeVariances(pilot);
  std::vector<double> weights(relative.size());
  double total = 0;
  for (int y = 0; y < pilot.height; ++y)
    for (int x = 0; x < pilot.width; ++x) {
      double sum = 0, norm = 0;
      forNeighbors(pilot, x, y, [&](size_t j, int dx, int dy) {
        sum += windowWeight(dx, dy) * relative[j];
        norm += windowWeight(dx, dy);
      });
      total += weights[index(x, y)] = norm > 0 ? std::sqrt(sum / norm) : 0;
    }

  for (int y = 0; y < pilot.height; ++y)
    for (int x = 0; x < pilot.width; ++x) {
      const size_t i = index(x, y);
      if (isMeter(i)) continue;
      // The weights of the neighbours depend on this pixel; other weights do not.
      double others = total, count = double(weights.size());
      forNeighbors(pilot, x, y, [&](size_t j, int, int) { others -= weights[j], --count; });
      if (others > 1e-12 * total)
        rates_[i] = std::clamp(float(weights[i] * count / others), leastRate, kMaxRate);
    }
}

uint32_t SampleAllocation::count(int x, int y, uint32_t mean) const {
  if (mean <= pilotSamples_) return mean;
  const size_t i = index(x, y);
  // Rounded up or down at random, by the same number for every `mean`.
  const double threshold = double(uint32_t(hash(i, 0x726f756e64))) * 0x1p-32;
  const double more = double(mean - pilotSamples_) * rates_[i] + threshold;
  return uint32_t(std::min(pilotSamples_ + std::floor(more), kMaxCount));
}

void SampleAllocation::archive(Archive& a) {
  a(pilotSamples_);
  a.fixed(rates_);
  for (const float rate : rates_) a.check(rate >= 0 && rate <= kMaxRate);
}

}  // namespace chromeball
