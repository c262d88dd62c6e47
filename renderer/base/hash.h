// SPDX-License-Identifier: Apache-2.0
// Integer hashes. They are the only source of randomness, so that every random number depends on
// its key alone.
#pragma once

#include <cstdint>
#include <span>

namespace chromeball {

// Avalanches 64 bits (the finaliser of SplitMix64, Steele et al. 2014).
inline uint64_t hash(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

template <class... Rest>
uint64_t hash(uint64_t first, uint64_t second, Rest... rest) {
  return hash(hash(first) ^ second, rest...);
}

// The top 24 bits as a float in [0, 1).
inline float toUnit(uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

// Detects damage, and tells descriptions apart (XXH3); no protection against intent.
uint64_t checksum(std::span<const char> bytes);

}  // namespace chromeball
