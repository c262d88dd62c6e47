// SPDX-License-Identifier: Apache-2.0
#include "math/sampler.h"

#include <array>
#include <cassert>

namespace chromeball {
namespace {

uint32_t reverseBits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

using DirectionNumbers = std::array<uint32_t, 32>;

// Primitive polynomial of degree s with inner coefficients a, and initial odd numbers m.
DirectionNumbers directionNumbers(int s, uint32_t a, const std::array<uint32_t, 3>& m) {
  DirectionNumbers v{};
  for (int i = 0; i < 32; ++i) {
    if (i < s) {
      v[i] = m[i] << (31 - i);
      continue;
    }
    v[i] = v[i - s] ^ (v[i - s] >> s);
    for (int k = 1; k < s; ++k)
      if ((a >> (s - 1 - k)) & 1) v[i] ^= v[i - k];
  }
  return v;
}

DirectionNumbers vanDerCorput() {
  DirectionNumbers v{};
  for (int i = 0; i < 32; ++i) v[i] = 1u << (31 - i);
  return v;
}

}  // namespace

uint32_t sobol(uint32_t index, int dimension) {
  static const std::array<DirectionNumbers, 4> numbers{vanDerCorput(), directionNumbers(1, 0, {1}),
                                                       directionNumbers(2, 1, {1, 3}),
                                                       directionNumbers(3, 1, {1, 3, 1})};
  uint32_t fraction = 0;
  for (int bit = 0; index; ++bit, index >>= 1)
    if (index & 1) fraction ^= numbers[dimension][bit];
  return fraction;
}

uint32_t owenScramble(uint32_t fraction, uint32_t seed) {
  uint32_t x = reverseBits(fraction);
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return reverseBits(x);
}

SobolTable::SobolTable(uint32_t points, int dimensions, uint64_t seed)
    : size_(points), dimensions_((dimensions + 3) & ~3) {
  assert((points & (points - 1)) == 0);
  fractions_.resize(std::size_t(size_) * dimensions_);
  for (int group = 0; group < dimensions_; group += 4) {
    const auto orderSeed = uint32_t(hash(seed, 1, group));
    std::array<uint32_t, 4> scrambles;
    for (int d = 0; d < 4; ++d) scrambles[d] = uint32_t(hash(seed, 2, group + d));
    for (uint32_t i = 0; i < size_; ++i) {
      const uint32_t index = owenScramble(i, orderSeed);
      for (int d = 0; d < 4; ++d)
        fractions_[std::size_t(i) * dimensions_ + group + d] =
            owenScramble(sobol(index, d), scrambles[d]);
    }
  }
}

}  // namespace chromeball
