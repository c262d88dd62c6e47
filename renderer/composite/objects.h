// SPDX-License-Identifier: Apache-2.0
// Ray masks of the two worlds of a composite: with and without the synthetic objects.
#pragma once

#include <vector>

#include "trace/ray.h"

namespace chromeball {

// By instance: true for a synthetic object, false for the local scene (a model of real surfaces in
// the plate).
using ObjectMask = std::vector<bool>;

// Rays with kLocalScene hit only the local scene; rays with kAllInstances also hit the objects.
inline constexpr RayMask kLocalScene = 1, kObjects = 2;

// The masks for the World of a composite.
inline std::vector<RayMask> rayMasks(const ObjectMask& isObject) {
  std::vector<RayMask> masks;
  for (const bool object : isObject) masks.push_back(object ? kObjects : kLocalScene);
  return masks;
}

}  // namespace chromeball
