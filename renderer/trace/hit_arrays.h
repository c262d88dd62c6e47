// SPDX-License-Identifier: Apache-2.0
// The closest hits of rays in arrays (math/lanes.h).
#pragma once

#include <optional>

#include "math/lanes.h"
#include "trace/ray.h"

namespace chromeball {

// As Hit.
struct HitArrays {
  static constexpr int32_t kNone = -1;
  alignas(64) LaneArray<int32_t> instance;  // kNone: the ray escapes
  alignas(64) LaneArray<int32_t> triangle;
  alignas(64) LaneArray<float> u, v;  // barycentric
  alignas(64) LaneArray<float> distance;

  std::optional<Hit> at(size_t i) const {
    if (instance[i] == kNone) return {};
    return Hit{uint32_t(instance[i]), uint32_t(triangle[i]), {u[i], v[i]}, distance[i]};
  }
  void set(size_t i, const std::optional<Hit>& hit) {
    instance[i] = kNone;
    if (hit) set(i, *hit);
  }
  void set(size_t i, const Hit& hit) {
    instance[i] = int32_t(hit.instance), triangle[i] = int32_t(hit.triangle);
    u[i] = hit.barycentric.x, v[i] = hit.barycentric.y, distance[i] = hit.distance;
  }
};

}  // namespace chromeball
