// SPDX-License-Identifier: Apache-2.0
// Rays, and other things, in arrays: one for each of their numbers, for code that works in lanes.
#pragma once

#include <array>

#include "math/lanes.h"

namespace chromeball {

// The arrays have room for one vector more than is used, since lanes are stored in whole vectors.
inline constexpr size_t kMostInArrays = 64, kArraySize = kMostInArrays + 8;
template <class T>
using LaneArray = std::array<T, kArraySize>;

// Vectors, or colours.
struct LaneArrays3 {
  alignas(64) LaneArray<float> x, y, z;

  Lanes3<Float8> load(size_t i) const {
    return {loadLanes(&x[i]), loadLanes(&y[i]), loadLanes(&z[i])};
  }
  void store(size_t i, const Lanes3<Float8>& v) {
    storeLanes(&x[i], v.x), storeLanes(&y[i], v.y), storeLanes(&z[i], v.z);
  }
  void store(size_t i, const Lanes3<Float8>& v, const LanePacking& packing) {
    packing.store(&x[i], v.x), packing.store(&y[i], v.y), packing.store(&z[i], v.z);
  }
  vec3 at(size_t i) const { return {x[i], y[i], z[i]}; }
  void set(size_t i, const vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

// Rays without an end; the directions are unit.
struct RayArrays {
  LaneArrays3 origin, direction;
};

}  // namespace chromeball
