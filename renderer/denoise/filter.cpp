// SPDX-License-Identifier: Apache-2.0
#include "denoise/filter.h"

#include <cmath>
#include <span>

#include "denoise/planes.h"

namespace chromeball {
namespace {

constexpr int kWidth = TileWeights::kWidth, kHeight = TileWeights::kHeight;

// Calls visit(half, tile) for all tiles of both halves. Tiles of a half that run at the same time
// write to different pixels (addRegressions()), and each pixel is written in the same order,
// whatever the number of threads.
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
    parallelFor(0, 2 * columns * rows, [&](int each) {
      if (stop) return;
      const int i = each / 2;
      const int left = (i % columns * kColumnPhases + px) * kWidth;
      const int top = (i / columns * kRowPhases + py) * kHeight;
      visit(size_t(each % 2),
            PixelArea{left, top, std::min(kWidth, width - left), std::min(kHeight, height - top)});
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

void averageArea(const TileWeights& weights, int power, std::span<const Plane> channels,
                 const PixelArea& area, std::span<Plane> means) {
  for (int y = 0; y < area.height; ++y)
    for (int x = 0; x < area.width; x += kLanes)
      average(weights, power, size_t(y * kWidth + x), channels, area.left + x, area.top + y, means);
}

// The least area of a tile that has all pixels with isWanted(x, y), in whole vectors: a vector
// beyond the area would be of pixels that other weights filter.
template <class IsWanted>
PixelArea boundsOf(const PixelArea& tile, const IsWanted& isWanted) {
  int left = tile.right(), right = tile.left, top = tile.bottom(), bottom = tile.top;
  for (int y = tile.top; y < tile.bottom(); ++y)
    for (int x = tile.left; x < tile.right(); ++x)
      if (isWanted(x, y)) {
        left = std::min(left, x), right = std::max(right, x + 1);
        top = std::min(top, y), bottom = y + 1;
      }
  if (left >= right) return {tile.left, tile.top, 0, 0};
  left -= (left - tile.left) % kLanes;
  right = std::min(tile.left + (right - tile.left + kLanes - 1) / kLanes * kLanes, tile.right());
  return {left, top, right - left, bottom - top};
}

// Whether the noise of a pixel is far below its size.
bool isClean(const NoisyPlanes& planes, int x, int y) {
  float size = 0, variance = 0;
  for (size_t c = 0; c < planes.values.size(); ++c) {
    size += planes.values[c].at(x, y) * planes.values[c].at(x, y);
    variance += planes.variances[c].at(x, y);
  }
  return isNegligible(variance, size);
}

void copyTile(std::span<const Plane> from, const PixelArea& tile, std::span<Plane> to) {
  for (size_t c = 0; c < from.size(); ++c)
    for (int y = tile.top; y < tile.bottom(); ++y)
      std::copy(from[c].row(y) + tile.left, from[c].row(y) + tile.right(),
                to[c].row(y) + tile.left);
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

HalfChannels averageHalves(const HalfGuides& halves, Scratch& scratch,
                           const std::atomic<bool>& stop) {
  const int width = halves[0].values[0].width(), height = halves[0].values[0].height();
  HalfChannels results;
  for (std::vector<Plane>& means : results)
    for (size_t c = 0; c < halves[0].values.size(); ++c) means.emplace_back(width, height);
  forTiles(width, height, stop, [&](size_t half, const PixelArea& tile) {
    const NoisyPlanes &own = halves[half], &other = halves[1 - half];
    copyTile(own.values, tile, results[half]);
    const PixelArea noisy = boundsOf(tile, [&](int x, int y) { return !isClean(other, x, y); });
    if (noisy.empty()) return;
    TileWeights& weights = scratch.local();
    weights.compute(other, noisy, {});
    averageArea(weights, 1, own.values, noisy, results[half]);
  });
  for (std::vector<Plane>& means : results)
    for (Plane& mean : means) mean.extend();
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
                            Scratch& scratch, const std::atomic<bool>& stop) {
  const int width = component.variance[0].width(), height = component.variance[0].height();
  FilteredHalves results;
  std::vector<Predictions> predictions[2];  // of each half
  for (size_t half = 0; half < 2; ++half) {
    for (int i = 0; i < kBandwidths; ++i) predictions[half].emplace_back(width, height);
    if (averagePower > 0)
      for (Plane& mean : results.averages[half]) mean = Plane(width, height);
  }
  forTiles(width, height, stop, [&](size_t half, const PixelArea& tile) {
    const RgbPlanes& color = component.halves[half];
    if (averagePower > 0) copyTile(color, tile, results.averages[half]);
    const PixelArea used =
        boundsOf(tile, [&](int x, int y) { return component.wanted.at(x, y) != 0; });
    if (used.empty()) return;
    // Every second row has the centres of windows, other rows in each half: 1.7 times faster, with
    // the same error (docs/measured/results.md). Each window predicts 15 rows.
    const int first = std::min((used.top + int(half)) % 2, used.height - 1);
    const TileWeights::Rows all, centres{first, 2};
    TileWeights& weights = scratch.local();
    weights.compute(guides[1 - half], used, averagePower > 0 ? all : centres);
    for (size_t i = 0; i < kBandwidths; ++i)
      addRegressions(weights, powers[i], color, features, used, centres, predictions[half][i]);
    if (averagePower > 0) averageArea(weights, averagePower, color, used, results.averages[half]);
  });
  for (size_t half = 0; half < 2; ++half) {
    for (size_t i = 0; i < kBandwidths; ++i)
      results.regressions[i][half] = finished(predictions[half][i], component.halves[half]);
    if (averagePower > 0)
      for (Plane& mean : results.averages[half]) mean.extend();
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
