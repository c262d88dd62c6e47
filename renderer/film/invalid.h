// SPDX-License-Identifier: Apache-2.0
// Samples that are NaN, infinite or negative. They are counted and excluded from all means.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "math/vec.h"

namespace chromeball {

enum class Defect { Nan, Infinite, Negative };

// The defect of a sample, tested in the order of the enum; nullopt if it is valid. `isSigned`:
// negative values are valid.
inline std::optional<Defect> defectOf(const Rgb& radiance, bool isSigned) {
  const auto any = [&](auto holds) {
    return holds(radiance.x) || holds(radiance.y) || holds(radiance.z);
  };
  if (any([](float x) { return std::isnan(x); })) return Defect::Nan;
  if (any([](float x) { return std::isinf(x); })) return Defect::Infinite;
  if (!isSigned && any([](float x) { return x < 0; })) return Defect::Negative;
  return std::nullopt;
}

struct InvalidSamples {
  std::array<uint64_t, 3> counts{};  // by Defect
  int x = -1, y = -1;                // the first affected pixel in scanline order

  uint64_t of(Defect defect) const { return counts[size_t(defect)]; }
  uint64_t total() const { return counts[0] + counts[1] + counts[2]; }

  void add(Defect defect, int atX, int atY) {
    InvalidSamples one;
    one.counts[size_t(defect)] = 1;
    one.x = atX, one.y = atY;
    add(one);
  }
  void add(const InvalidSamples& other) {
    if (other.total() == 0) return;
    const bool isFirst = total() == 0 || other.y < y || (other.y == y && other.x < x);
    if (isFirst) x = other.x, y = other.y;
    for (size_t i = 0; i < counts.size(); ++i) counts[i] += other.counts[i];
  }
};

}  // namespace chromeball
