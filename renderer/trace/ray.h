// SPDX-License-Identifier: Apache-2.0
// Rays and hits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "math/vec.h"
#include "scene/scene.h"

namespace chromeball {

// A bit mask. A ray hits the instances whose mask has a bit in common with its own.
using RayMask = uint32_t;
inline constexpr RayMask kAllInstances = ~0u;

struct Ray {
  vec3 origin;
  vec3 direction;  // unit
  float tMax = INFINITY;
  float time = 0;  // at which it sees the scene (scene/motion.h)

  void endAt(const vec3& position) {
    tMax = glm::length(position - origin);
    direction = (position - origin) / tMax;
  }
};

struct Hit {
  uint32_t instance;  // index into Scene::instances
  uint32_t triangle;  // index into the mesh's triangles
  vec2 barycentric;   // weights of the second and third vertex
  float distance;     // along the ray, metres
};

// Rays that hit a triangle so close to an edge that rounding decides which side they pass.

// A cheap test before turnedOffEdges(). It misses edges of triangles so small, or seen so nearly
// edge-on, that the rounding error exceeds 1% of their projected height: heights below 25 um at 1
// m.
inline bool isNearEdge(const Hit& hit) {
  const vec2& b = hit.barycentric;
  return std::min({b.x, b.y, 1 - b.x - b.y}) < 0.01f;
}

// A ray that grazes the edge between a front-facing and a back-facing triangle of a body can miss
// the front-facing one by a rounding error and hit the other one from inside the body, so that
// light leaks out. This function turns the ray, by a few rounding errors, towards the inside of the
// triangle of `hit`, so that the turned ray hits the front-facing triangle first. Returns nullopt
// if the hit is not at an edge, or if the hit is so close that the ray would turn by more than
// 1e-3.
std::optional<Ray> turnedOffEdges(const Scene& scene, const Ray& ray, const Hit& hit);

}  // namespace chromeball
