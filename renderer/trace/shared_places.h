// SPDX-License-Identifier: Apache-2.0
// Triangles that lie in the same place as an emitting one.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <unordered_set>

#include "trace/accel.h"

namespace chromeball {

// The triangles of a scene, emitting or not, that coincide with an emitting one over some area, and
// these emitting triangles themselves. Which of the surfaces at such a place a ray hits is
// arbitrary, so that paths and light samples must ask what a path meets there (transport/place.h).
// A few others may be among them.
class SharedPlaces {
 public:
  explicit SharedPlaces(const Accel& accel);

  bool contains(uint32_t instance, uint32_t triangle) const {
    return all_ || (!triangles_.empty() && triangles_.contains(keyOf(instance, triangle)));
  }

 private:
  static uint64_t keyOf(uint32_t instance, uint32_t triangle) {
    return uint64_t(instance) << 32 | triangle;
  }
  void addPartnersOf(const Accel& accel, uint32_t instance, uint32_t triangle, float time,
                     std::atomic<int64_t>& budget);

  bool all_ = false;
  std::mutex mutex_;  // of triangles_, while they are found
  std::unordered_set<uint64_t> triangles_;
};

}  // namespace chromeball
