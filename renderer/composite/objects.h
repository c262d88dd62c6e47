// SPDX-License-Identifier: Apache-2.0
// The two worlds of a composite as classes of instances.
#pragma once

#include <vector>

#include "trace/ray.h"

namespace chromeball {

// By instance: true for a synthetic object, false for the local scene, which stands for real
// things.
using ObjectMask = std::vector<bool>;

// Rays with kLocalScene meet the local scene alone; rays with kAllInstances meet both.
inline constexpr RayMask kLocalScene = 1, kObjects = 2;

// The masks of a World that composites are rendered in.
inline std::vector<RayMask> rayMasks(const ObjectMask& isObject) {
  std::vector<RayMask> masks;
  for (const bool object : isObject) masks.push_back(object ? kObjects : kLocalScene);
  return masks;
}

}  // namespace chromeball
