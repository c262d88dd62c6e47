// SPDX-License-Identifier: Apache-2.0
// From a scene at several times to its motion.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

// Gives the instances and lamps of `scene`, which is at the opening of the shutter, the places and
// shapes that they have in `later`, at equally spaced times up to its closing. Returns the names of
// the nodes with parts that `scene` or one of `later` lacks.
std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later);

// How well straight lines between keys follow the motion.
struct MotionError {
  double farthest = 0;   // from where a vertex is at the opening, metres
  double deviation = 0;  // of a vertex from its true place, metres

  // Compares the motion of `scene` at `time` with the scene as it is then.
  void add(const Scene& scene, const Scene& then, float time);
};

}  // namespace chromeball
