// SPDX-License-Identifier: Apache-2.0
#include "denoise/fireflies.h"

#include <cmath>

namespace chromeball {
namespace {

constexpr int kReach = TileWeights::kReach;
constexpr int kBiasReach = 3 * kReach;
constexpr float kWindow = (2 * kReach + 1) * (2 * kReach + 1);

Plane energyOf(const RgbPlanes& image) {
  return makePlane(image[0].width(), image[0].height(), [&](int x, int y) {
    float sum = 0;
    for (const Plane& channel : image) sum += channel.at(x, y) * channel.at(x, y);
    return sum;
  });
}

// The factors of the pixels of a half with `energy`.
Plane factorsOf(const Plane& energy, const Plane& otherEnergy) {
  const Plane support = boxMean(otherEnergy, kReach);
  return makePlane(energy.width(), energy.height(), [&](int x, int y) {
    const float limit = kWindow * support.at(x, y);
    return energy.at(x, y) > limit ? std::sqrt(limit / energy.at(x, y)) : 1.0f;
  });
}

}  // namespace

RgbPlanes limitFireflies(HalfPlanes& halves) {
  const std::array<Plane, 2> energies{energyOf(halves[0]), energyOf(halves[1])};
  const std::array<Plane, 2> factors{factorsOf(energies[0], energies[1]),
                                     factorsOf(energies[1], energies[0])};
  const int width = factors[0].width(), height = factors[0].height();
  RgbPlanes squaredBias;
  for (size_t c = 0; c < 3; ++c) {
    std::array<Plane, 2> losses;
    for (size_t h = 0; h < 2; ++h) {
      Plane& half = halves[h][c];
      const Plane limited = makePlane(
          width, height, [&](int x, int y) { return factors[h].at(x, y) * half.at(x, y); });
      losses[h] = boxMean(
          makePlane(width, height, [&](int x, int y) { return half.at(x, y) - limited.at(x, y); }),
          kBiasReach);
      half = limited;
    }
    squaredBias[c] = makePlane(width, height, [&](int x, int y) {
      return std::fabs(losses[0].at(x, y) * losses[1].at(x, y));
    });
  }
  return squaredBias;
}

}  // namespace chromeball
