// SPDX-License-Identifier: Apache-2.0
// A function tabulated at the nodes of a regular grid of any dimension.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "math/vec.h"

namespace chromeball {

// A position along one dimension of a grid: between nodes `low` and `low + 1`, at the fraction
// `blend` in [0, 1] of the way.
struct GridPosition {
  int low;
  float blend;

  // `t`: 0 at the first of `nodes` nodes (at least 2), 1 at the last; clamped, and NaN counts as 0.
  GridPosition(float t, int nodes) {
    const float inside = t > 0 ? t : 0;  // false for NaN
    const float x = (inside < 1 ? inside : 1) * float(nodes - 1);
    low = std::min(int(x), nodes - 2);
    blend = x - float(low);
  }
};

// `kNodes`: the number of nodes along each dimension, at least 2. Nodes that are neighbours in the
// last dimension are neighbours in memory. Reading is safe from several threads.
template <class Value, int... kNodes>
class GridTable {
 public:
  static constexpr size_t kDimensions = sizeof...(kNodes);
  static constexpr std::array<int, kDimensions> kSize{kNodes...};
  using Position = std::array<GridPosition, kDimensions>;

  GridTable() : values_((size_t(kNodes) * ...)) {}

  // The value at the node with these indices.
  Value& node(const std::array<int, kDimensions>& indices) { return values_[offsetOf(indices)]; }
  const Value& node(const std::array<int, kDimensions>& indices) const {
    return values_[offsetOf(indices)];
  }

  // Multilinear interpolation, along the last dimension first, by mix(a, b, blend): glm::mix, or an
  // overload found by argument-dependent lookup for Value.
  Value interpolate(const Position& position) const { return mixAlong<0>(position, 0); }

  // Calls visit(value, weight) for the 2^kDimensions corners around the position: the sum of weight
  // times value is interpolate() up to rounding.
  template <class Visit>
  void forCorners(const Position& position, Visit&& visit) const {
    for (int corner = 0; corner < 1 << kDimensions; ++corner) {
      int offset = 0;
      float weight = 1;
      for (size_t d = 0; d < kDimensions; ++d) {
        const int high = corner >> d & 1;
        offset = offset * kSize[d] + position[d].low + high;
        weight *= high ? position[d].blend : 1 - position[d].blend;
      }
      visit(values_[size_t(offset)], weight);
    }
  }

 private:
  static size_t offsetOf(const std::array<int, kDimensions>& indices) {
    size_t offset = 0;
    for (size_t d = 0; d < kDimensions; ++d)
      offset = offset * size_t(kSize[d]) + size_t(indices[d]);
    return offset;
  }

  // `offset`: index of the line, plane, ... chosen by the dimensions before kDimension.
  template <size_t kDimension>
  Value mixAlong(const Position& position, size_t offset) const {
    using glm::mix;
    const auto [low, blend] = position[kDimension];
    offset = offset * size_t(kSize[kDimension]) + size_t(low);
    if constexpr (kDimension + 1 == kDimensions)
      return mix(values_[offset], values_[offset + 1], blend);
    else
      return mix(mixAlong<kDimension + 1>(position, offset),
                 mixAlong<kDimension + 1>(position, offset + 1), blend);
  }

  std::vector<Value> values_;
};

}  // namespace chromeball
