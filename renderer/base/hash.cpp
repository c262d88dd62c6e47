// SPDX-License-Identifier: Apache-2.0
#include "base/hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace chromeball {

uint64_t checksum(std::span<const char> bytes) {
  // Four sums that do not wait for each other. A step is a bijection of the sum and of the word.
  constexpr uint64_t kOdd = 0x9e3779b97f4a7c15u;
  constexpr size_t kWord = sizeof(uint64_t);
  std::array<uint64_t, 4> sums{1, 2, 3, 4};
  const auto add = [](uint64_t& sum, const char* at, size_t count) {
    uint64_t word = 0;
    std::memcpy(&word, at, count);
    sum = std::rotl((sum ^ word) * kOdd, 29);
  };
  const char* at = bytes.data();
  const char* end = at + bytes.size();
  for (; size_t(end - at) >= sums.size() * kWord; at += sums.size() * kWord)
    for (size_t i = 0; i < sums.size(); ++i) add(sums[i], at + i * kWord, kWord);
  for (size_t i = 0; at < end; ++i) {
    const size_t count = std::min(kWord, size_t(end - at));
    add(sums[i], at, count);
    at += count;
  }
  return hash(sums[0], sums[1], sums[2], sums[3], uint64_t(bytes.size()));
}

}  // namespace chromeball
