// SPDX-License-Identifier: Apache-2.0
// Triangles of glass with which no other surface coincides.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "trace/accel.h"

namespace chromeball {

// A path that passes a surface must look for others in the same place (Accel::forEachCoincident()).
// For the triangles of materials that transmit, this remembers that there are none: each is looked
// at once, when a path first comes to it.
class LoneTriangles {
 public:
  // The structure must outlive this.
  explicit LoneTriangles(const Accel& accel);

  // Whether no other surface comes within the reach of Accel::forEachCoincident() of the triangle.
  // False for those that are not remembered. Thread-safe.
  bool contains(uint32_t instance, uint32_t triangle) const {
    const size_t first = firsts_.empty() ? kNone : firsts_[instance];
    if (first == kNone) return false;
    std::atomic<State>& state = states_[first + triangle];
    const State known = state.load(std::memory_order_relaxed);
    if (known != State::Unknown) [[likely]]
      return known == State::Lone;
    const bool isLone = !touchesOthers(instance, triangle);
    state.store(isLone ? State::Lone : State::Touching, std::memory_order_relaxed);
    return isLone;
  }

 private:
  enum class State : uint8_t { Unknown, Lone, Touching };
  static constexpr size_t kNone = size_t(-1);

  bool touchesOthers(uint32_t instance, uint32_t triangle) const;

  const Accel& accel_;
  std::vector<size_t> firsts_;  // by instance: of its triangles; kNone: not remembered
  mutable std::vector<std::atomic<State>> states_;
};

}  // namespace chromeball
