// SPDX-License-Identifier: Apache-2.0
// What an eye within the scene sees in all directions.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace chromeball {

struct Sight {
  glm::dvec3 direction;        // unit
  double distance = INFINITY;  // of the nearest surface, metres; infinite: none
  glm::dvec3 normal{0};        // unit, of its front
  bool showsBack = false;      // the back of a single-sided surface, which is no wall of a room

  bool isWall() const { return distance < INFINITY && !showsBack; }
};

// The nearest surfaces of the instances (indices into scene.instances) in 320 directions spread
// evenly over the sphere. O(triangles).
std::vector<Sight> sightsFrom(const Scene& scene, const std::vector<int>& instances,
                              const glm::dvec3& eye);

}  // namespace chromeball
