// SPDX-License-Identifier: Apache-2.0
#include "denoise/filter.h"

#include <cmath>
#include <span>

#include "base/parallel.h"
#include "denoise/planes.h"

namespace chromeball {
namespace {

constexpr int kWidth = TileWeights::kWidth, kHeight = TileWeights::kHeight;

// Calls visit(left, top) for all tiles. Tiles that run at the same time write to different pixels
// (addRegressions()), and each pixel is written in the same order, whatever the number of threads.
template <class Visit>
void forTiles(int width, int height, const std::atomic<bool>& stop, const Visit& visit) {
  constexpr int kColumnPhases = 2, kRowPhases = 2;
  static_assert((kColumnPhases - 1) * kWidth >= 2 * TileWeights::kReach + kLanes);
  static_assert((kRowPhases - 1) * kHeight >= 2 * TileWeights::kReach);
  const auto along = [](int pixels, int size, int phase, int phases) {
    return ((pixels + size - 1) / size - phase + phases - 1) / phases;
  };
  for (int phase = 0; phase < kColumnPhases * kRowPhases; ++phase) {
    const int px = phase % kColumnPhases, py = phase / kColumnPhases;
    const int columns = along(width, kWidth, px, kColumnPhases);
    const int rows = along(height, kHeight, py, kRowPhases);
    parallelFor(0, columns * rows, [&](int i) {
      if (stop) return;
      visit((i % columns * kColumnPhases + px) * kWidth, (i / columns * kRowPhases + py) * kHeight);
    });
  }
}

RgbPlanes finished(const Predictions& predictions, const RgbPlanes& noisy) {
  const Plane& weights = predictions.weights;
  RgbPlanes result;
  for (size_t c = 0; c < 3; ++c)
    result[c] = makePlaneLike(weights, [&](int x, int y) {
      const float weight = weights.at(x, y);
      return weight > 0 ? predictions.weighted[c].at(x, y) / weight : noisy[c].at(x, y);
    });
  return result;
}

// Averages eight pixels from (x, y); `index` is the first one's in its tile. `power` is a power of
// two.
void average(const TileWeights& weights, int power, size_t index, std::span<const Plane> channels,
             int x, int y, std::span<Plane> means) {
  Float8 sums[3]{}, weightSum{};
  forNeighbours([&](size_t neighbour, int dx, int dy) {
    Float8 weight = load8(&weights[neighbour][index]);
    for (int i = 1; i < power; i *= 2) weight *= weight;
    for (size_t c = 0; c < channels.size(); ++c)
      sums[c] += weight * load8(channels[c].row(y + dy) + x + dx);
    weightSum += weight;
  });
  for (size_t c = 0; c < channels.size(); ++c) store8(means[c].row(y) + x, sums[c] / weightSum);
}

void averageTile(const TileWeights& weights, int power, std::span<const Plane> channels, int left,
                 int top, std::span<Plane> means) {
  const int bottom = std::min(top + kHeight, channels[0].height());
  const int right = std::min(left + kWidth, channels[0].width());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; x += kLanes)
      average(weights, power, size_t((y - top) * kWidth + x - left), channels, x, y, means);
}

// Whether the noise of all pixels of the tile is far below their size.
bool isClean(const NoisyPlanes& planes, int left, int top, int right, int bottom) {
  constexpr float kNegligible = 0.002f;  // relative
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      float size = 0, variance = 0;
      for (size_t c = 0; c < planes.values.size(); ++c) {
        size += planes.values[c].at(x, y) * planes.values[c].at(x, y);
        variance += planes.variances[c].at(x, y);
      }
      if (variance > kNegligible * kNegligible * size) return false;
    }
  return true;
}

void copyTile(const std::vector<Plane>& from, int left, int top, int right, int bottom,
              std::vector<Plane>& to) {
  for (size_t c = 0; c < from.size(); ++c)
    for (int y = top; y < bottom; ++y)
      std::copy(from[c].row(y) + left, from[c].row(y) + right, to[c].row(y) + left);
}

// The reach of the window that must hold as much light in the other half. A window as wide as the
// filter's has light of other objects, which says nothing about this pixel.
constexpr int kFireflyReach = 2;
constexpr float kFireflyWindow = (2 * kFireflyReach + 1) * (2 * kFireflyReach + 1);
constexpr int kFireflyBiasReach = 3 * TileWeights::kReach;

Plane energyOf(const RgbPlanes& image) {
  return makePlaneLike(image[0], [&](int x, int y) {
    float sum = 0;
    for (const Plane& channel : image) sum += channel.at(x, y) * channel.at(x, y);
    return sum;
  });
}

// The factors of the pixels of a half with `energy`.
Plane factorsOf(const Plane& energy, const Plane& otherEnergy) {
  const Plane support = boxMean(otherEnergy, kFireflyReach);
  return makePlaneLike(energy, [&](int x, int y) {
    const float limit = kFireflyWindow * support.at(x, y);
    return energy.at(x, y) > limit ? std::sqrt(limit / energy.at(x, y)) : 1.0f;
  });
}

// Scales the pixels of a half. Returns the mean light over the channels that is removed around each
// pixel.
Plane limit(RgbPlanes& half, const Plane& factors) {
  const int width = factors.width(), height = factors.height();
  const Plane removed = makePlane(width, height, [&](int x, int y) {
    const float sum = half[0].at(x, y) + half[1].at(x, y) + half[2].at(x, y);
    return (1 - factors.at(x, y)) * sum / 3;
  });
  for (Plane& channel : half)
    channel =
        makePlane(width, height, [&](int x, int y) { return factors.at(x, y) * channel.at(x, y); });
  return boxMean(removed, kFireflyBiasReach);
}

}  // namespace

HalfChannels averageHalves(const HalfGuides& halves, const std::atomic<bool>& stop) {
  const int width = halves[0].values[0].width(), height = halves[0].values[0].height();
  HalfChannels results;
  PerThread<TileWeights> tileWeights;
  for (size_t half = 0; half < 2; ++half) {
    const std::vector<Plane>& channels = halves[half].values;
    std::vector<Plane>& means = results[half];
    for (size_t c = 0; c < channels.size(); ++c) means.emplace_back(width, height);
    forTiles(width, height, stop, [&](int left, int top) {
      const int bottom = std::min(top + kHeight, height), right = std::min(left + kWidth, width);
      if (isClean(halves[1 - half], left, top, right, bottom)) {
        copyTile(channels, left, top, right, bottom, means);
        return;
      }
      TileWeights& weights = tileWeights.local();
      weights.compute(halves[1 - half], left, top);
      averageTile(weights, 1, channels, left, top, means);
    });
    for (Plane& mean : means) mean.extend();
  }
  return results;
}

HalfGuides guidesOf(const Component& component) {
  HalfGuides guides;
  for (size_t half = 0; half < 2; ++half)
    for (size_t c = 0; c < 3; ++c) {
      const Plane& variance = component.variance[c];
      guides[half].values.push_back(component.halves[half][c]);
      guides[half].variances.push_back(makePlaneLike(
          variance, [&](int x, int y) { return 2 * variance.at(x, y); }));  // half of the samples
    }
  return guides;
}

FilteredHalves filterHalves(const Component& component, const HalfGuides& guides,
                            const FeaturePlanes& features,
                            const std::array<int, kBandwidths>& powers, int averagePower,
                            const std::atomic<bool>& stop) {
  const int width = component.variance[0].width(), height = component.variance[0].height();
  FilteredHalves results;
  PerThread<TileWeights> tileWeights;
  for (size_t half = 0; half < 2; ++half) {
    std::array<Predictions, kBandwidths> predictions{Predictions(width, height),
                                                     Predictions(width, height)};
    RgbPlanes& means = results.averages[half];
    if (averagePower > 0)
      for (Plane& mean : means) mean = Plane(width, height);
    forTiles(width, height, stop, [&](int left, int top) {
      TileWeights& weights = tileWeights.local();
      weights.compute(guides[1 - half], left, top);
      for (size_t i = 0; i < kBandwidths; ++i)
        addRegressions(weights, powers[i], component.halves[half], features, left, top,
                       predictions[i]);
      if (averagePower > 0)
        averageTile(weights, averagePower, component.halves[half], left, top, means);
    });
    for (size_t i = 0; i < kBandwidths; ++i)
      results.regressions[i][half] = finished(predictions[i], component.halves[half]);
    if (averagePower > 0)
      for (Plane& mean : means) mean.extend();
  }
  return results;
}

Plane limitFireflies(HalfPlanes& halves) {
  const std::array<Plane, 2> energies{energyOf(halves[0]), energyOf(halves[1])};
  const Plane a = limit(halves[0], factorsOf(energies[0], energies[1]));
  const Plane b = limit(halves[1], factorsOf(energies[1], energies[0]));
  return makePlaneLike(a, [&](int x, int y) { return std::fabs(a.at(x, y) * b.at(x, y)); });
}

}  // namespace chromeball
