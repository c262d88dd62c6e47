// SPDX-License-Identifier: Apache-2.0
// Rays and hits.
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace chromeball {

// A bit mask. A ray hits the instances whose mask has a bit in common with its own.
using RayMask = uint32_t;
inline constexpr RayMask kAllInstances = ~0u;

struct Ray {
  vec3 origin;
  vec3 direction;  // unit
  float tMax = INFINITY;
  float time = 0;  // at which it sees the scene (scene/motion.h)
};

struct Hit {
  uint32_t instance;  // index into Scene::instances
  uint32_t triangle;  // index into the mesh's triangles
  vec2 barycentric;   // weights of the second and third vertex
  float distance;     // along the ray, metres
};

}  // namespace chromeball
