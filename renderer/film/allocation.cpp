// SPDX-License-Identifier: Apache-2.0
#include "film/allocation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/hash.h"
#include "film/rows.h"

namespace chromeball {
namespace {

constexpr int kAllocationReach = 2;  // windows are 5 x 5 pixels, without the one in the middle
constexpr float kMaxRate = 64;       // keeps the work of a tile bounded
constexpr double kMaxCount = 4e9;    // of a pixel
constexpr uint64_t kPixelsPerMeter = 256;  // one of them measures the exposure

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
      // The weights of the neighbours depend on this pixel; the others' do not.
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
