// SPDX-License-Identifier: Apache-2.0
// Smooth noise for the demo's wood and clouds.
#pragma once

#include "base/hash.h"
#include "math/vec.h"

namespace chromeball {

// Lattice values in [0, 1), interpolated with 3t^2 - 2t^3.
inline float valueNoise(const vec3& p) {
  const vec3 cell = glm::floor(p), t = (p - cell) * (p - cell) * (3.0f - 2.0f * (p - cell));
  const auto corner = [&](int x, int y, int z) {
    return toUnit(uint32_t(hash(uint64_t(int64_t(cell.x) + x), uint64_t(int64_t(cell.y) + y),
                                uint64_t(int64_t(cell.z) + z))));
  };
  const auto row = [&](int y, int z) { return glm::mix(corner(0, y, z), corner(1, y, z), t.x); };
  return glm::mix(glm::mix(row(0, 0), row(1, 0), t.y), glm::mix(row(0, 1), row(1, 1), t.y), t.z);
}

// Octaves of valueNoise, each twice as fine and half as strong; in [0, 1).
inline float fractalNoise(vec3 p, int octaves) {
  float sum = 0, weight = 0.5f;
  for (int i = 0; i < octaves; ++i, p = 2.03f * p, weight *= 0.5f) sum += weight * valueNoise(p);
  return sum / (1 - 2 * weight);
}

}  // namespace chromeball
