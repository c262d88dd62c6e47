// SPDX-License-Identifier: Apache-2.0
#include "film/allocation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/hash.h"

namespace chromeball {
namespace {

constexpr int kReach = 2;            // windows are 5 x 5 pixels, without the one in the middle
constexpr float kMaxRate = 64;       // keeps the work of a tile bounded
constexpr double kMaxCount = 4e9;    // of a pixel
constexpr uint64_t kMeterOne = 256;  // one pixel of so many measures the exposure

// Gaussian with a standard deviation of one pixel.
double windowWeight(int dx, int dy) {
  constexpr double kWeights[kReach + 1] = {1, 0.606531, 0.135335};
  return kWeights[std::abs(dx)] * kWeights[std::abs(dy)];
}

struct Grid {
  int width, height;

  size_t index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }

  // Calls visit(index, dx, dy) for the pixels around (x, y).
  template <class Visit>
  void forNeighbors(int x, int y, const Visit& visit) const {
    for (int v = std::max(0, y - kReach); v <= std::min(height - 1, y + kReach); ++v)
      for (int u = std::max(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u)
        if (u != x || v != y) visit(index(u, v), u - x, v - y);
  }
};

// A metering pixel always takes the mean number of samples. It may therefore influence all others.
bool isMeter(size_t pixel) { return hash(pixel, 0x6d65746572) % kMeterOne == 0; }

double exposure(const std::vector<double>& luminances) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < luminances.size(); ++i)
    if (isMeter(i)) sum += luminances[i], ++count;
  return count > 0 ? sum / count : 0;
}

// Relative variances of the pixels, as `noise` defines them (film/noise.h); 0 where unknown.
std::vector<double> relativeVariances(const PixelErrors& pilot) {
  const double minLuminance = 0.01 * exposure(pilot.luminances);
  std::vector<double> relative(pilot.luminances.size(), 0.0);
  for (size_t i = 0; i < relative.size(); ++i) {
    const double reference = std::max(pilot.luminances[i], minLuminance);
    const double squared = pilot.scatter[i].w / (reference * reference);
    if (std::isfinite(squared)) relative[i] = squared;
  }
  return relative;
}

}  // namespace

SampleAllocation::SampleAllocation(const PixelErrors& pilot, uint32_t pilotSamples)
    : width_(pilot.width), pilotSamples_(pilotSamples), rates_(pilot.luminances.size(), 1.0f) {
  const Grid grid{pilot.width, pilot.height};
  const std::vector<double> relative = relativeVariances(pilot);
  std::vector<double> weights(relative.size());
  double total = 0;
  for (int y = 0; y < pilot.height; ++y)
    for (int x = 0; x < pilot.width; ++x) {
      double sum = 0, norm = 0;
      grid.forNeighbors(x, y, [&](size_t j, int dx, int dy) {
        sum += windowWeight(dx, dy) * relative[j];
        norm += windowWeight(dx, dy);
      });
      total += weights[grid.index(x, y)] = norm > 0 ? std::sqrt(sum / norm) : 0;
    }

  for (int y = 0; y < pilot.height; ++y)
    for (int x = 0; x < pilot.width; ++x) {
      const size_t i = grid.index(x, y);
      if (isMeter(i)) continue;
      // The weights of the neighbours depend on this pixel; the others' do not.
      double others = total, count = double(weights.size());
      grid.forNeighbors(x, y, [&](size_t j, int, int) { others -= weights[j], --count; });
      if (others > 1e-12 * total)
        rates_[i] = std::min(float(weights[i] * count / others), kMaxRate);
    }
}

uint32_t SampleAllocation::count(int x, int y, uint32_t mean) const {
  if (mean <= pilotSamples_) return mean;
  const size_t i = size_t(y) * size_t(width_) + size_t(x);
  // Rounded up or down at random, by the same number for every `mean`.
  const double threshold = double(uint32_t(hash(i, 0x726f756e64))) * 0x1p-32;
  const double more = double(mean - pilotSamples_) * rates_[i] + threshold;
  return uint32_t(std::min(pilotSamples_ + std::floor(more), kMaxCount));
}

}  // namespace chromeball
