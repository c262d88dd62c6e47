// SPDX-License-Identifier: Apache-2.0
// Keeps the numbers of largest magnitude, of more numbers than memory may hold.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// A histogram of magnitudes. Bins are 2^-11 wide, relatively: the magnitudes of floats have the
// order of their bits.
class Magnitudes {
 public:
  void add(std::span<const float> values) {
    for (const float value : values) ++counts_[binOf(value)];
  }
  void add(const Magnitudes& other);

  // The bin from which on the numbers are together at most `share` of all.
  size_t leastBin(double share) const;

  static size_t binOf(float value) {
    return (std::bit_cast<uint32_t>(value) & 0x7fffffffu) >> kShift;
  }

 private:
  static constexpr int kShift = 12;
  std::vector<uint64_t> counts_ = std::vector<uint64_t>(size_t(1) << (31 - kShift));
};

// Sets those below this bin to 0. Returns the number of zeros.
uint64_t dropBelow(size_t leastBin, std::span<float> values);

// Sets all but the largest magnitudes to 0: about `share` of the values stay. Returns the share of
// zeros.
double keepLargest(std::span<float> values, double share);

}  // namespace chromeball
