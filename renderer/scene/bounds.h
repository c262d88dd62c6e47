// SPDX-License-Identifier: Apache-2.0
// Axis-aligned boxes around points.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace chromeball {

struct Bounds {
  vec3 min{INFINITY}, max{-INFINITY};  // empty

  bool empty() const { return !(min.x <= max.x); }
  glm::dvec3 size() const { return glm::dvec3(max) - glm::dvec3(min); }
  void add(const vec3& p) { min = glm::min(min, p), max = glm::max(max, p); }
  void add(const Bounds& other) { min = glm::min(min, other.min), max = glm::max(max, other.max); }
};

Bounds bounds(const std::vector<vec3>& points);

// Bounds in the scene's coordinates: of one instance, of the instances with the given indices, and
// of all.
Bounds bounds(const Scene& scene, const Instance& instance);
Bounds bounds(const Scene& scene, const std::vector<int>& instances);
Bounds bounds(const Scene& scene);

}  // namespace chromeball
