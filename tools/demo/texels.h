// SPDX-License-Identifier: Apache-2.0
// Texels of the demo: smooth noise for wood, stone and clouds; and rounding, by which compressed
// images are smaller.
#pragma once

#include "base/hash.h"
#include "image/image.h"
#include "math/vec.h"

namespace chromeball::demo {

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

// Rounds to eleven significant bits, which makes the file a third as large.
inline void roundTexels(Image& image) {
  for (float& texel : image.texels) {
    int exponent;
    const float fraction = std::frexp(texel, &exponent);
    texel = std::ldexp(std::round(fraction * 2048) / 2048, exponent);
  }
}

}  // namespace chromeball::demo
