// SPDX-License-Identifier: Apache-2.0
#include "denoise/fireflies.h"

#include <cmath>

namespace chromeball {
namespace {

// Of the window that must hold as much light in the other half. One that is as wide as the filter's
// has light of other objects, which says nothing of this pixel.
constexpr int kFireflyReach = 2;
constexpr float kFireflyWindow = (2 * kFireflyReach + 1) * (2 * kFireflyReach + 1);
constexpr int kFireflyBiasReach = 3 * TileWeights::kReach;

Plane energyOf(const RgbPlanes& image) {
  return makePlane(image[0].width(), image[0].height(), [&](int x, int y) {
    float sum = 0;
    for (const Plane& channel : image) sum += channel.at(x, y) * channel.at(x, y);
    return sum;
  });
}

// The factors of the pixels of a half with `energy`.
Plane factorsOf(const Plane& energy, const Plane& otherEnergy) {
  const Plane support = boxMean(otherEnergy, kFireflyReach);
  return makePlane(energy.width(), energy.height(), [&](int x, int y) {
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

Plane limitFireflies(HalfPlanes& halves) {
  const std::array<Plane, 2> energies{energyOf(halves[0]), energyOf(halves[1])};
  const Plane a = limit(halves[0], factorsOf(energies[0], energies[1]));
  const Plane b = limit(halves[1], factorsOf(energies[1], energies[0]));
  return makePlane(a.width(), a.height(),
                   [&](int x, int y) { return std::fabs(a.at(x, y) * b.at(x, y)); });
}

}  // namespace chromeball
