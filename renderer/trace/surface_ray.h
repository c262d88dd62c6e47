// SPDX-License-Identifier: Apache-2.0
// Rays that leave a surface.
#pragma once

#include "scene/surface.h"
#include "trace/ray.h"

namespace chromeball {

// At the time at which the surface is seen.
inline Ray rayFrom(const Surface& surface, const vec3& direction, float tMax = INFINITY) {
  return {surface.rayOrigin(direction), direction, tMax, surface.time};
}

}  // namespace chromeball
