// SPDX-License-Identifier: Apache-2.0
// Owen-scrambled Sobol points, tabulated once for a render.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace chromeball {

// The Sobol sequence's coordinate in one of its first four dimensions, as a 32-bit fraction
// (direction numbers of Joe and Kuo 2008).
uint32_t sobol(uint32_t index, int dimension);

// Nested uniform (Owen) scrambling of a 32-bit fraction: every prefix of bits chooses a permutation
// of the bits below it (Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency",
// with the constants of Vegdahl 2021).
uint32_t owenScramble(uint32_t fraction, uint32_t seed);

// Points [0, 2^k) of a sequence with any number of dimensions. Four consecutive dimensions are one
// scrambled 4D Sobol sequence; the groups of four are padded: each visits its points in an
// independent nested-uniform order (Burley 2020, "Practical Hash-based Owen Scrambling"). Any
// aligned block of 2^j indices is as well distributed as the first 2^j.
class SobolTable {
 public:
  SobolTable(uint32_t points, int dimensions, uint64_t seed);  // points: a power of two

  uint32_t size() const { return size_; }
  int dimensions() const { return dimensions_; }
  const uint32_t* point(uint32_t index) const {
    return &fractions_[std::size_t(index) * dimensions_];
  }

 private:
  uint32_t size_;
  int dimensions_;
  std::vector<uint32_t> fractions_;
};

}  // namespace chromeball
