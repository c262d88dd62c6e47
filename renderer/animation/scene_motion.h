// SPDX-License-Identifier: Apache-2.0
// Derives motion from a scene at several times.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

// Gives the instances and lamps of `scene`, which is at the opening of the shutter, the places and
// shapes that they have in `later`, at equally spaced times up to its closing. Parts that one of
// `later` lacks stay as they were before. Returns the names of the nodes with parts or lamps that
// `scene` or one of `later` lacks.
std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later);

// How well keys follow the motion that they are taken from.

class MotionError {
 public:
  // Compares the moving parts of `scene` at `time` with `then`, the scene at that time.
  void add(const Scene& scene, const Scene& then, float time);
  void add(const Camera& camera, const Camera& then, float time);

  // The camera turns by this angle at constant speed while the shutter is open; keys half a turn or
  // more apart would not show its direction.
  void addTurn(double degrees, int steps);

  // A line for each of models, lamps and camera that misses its way by more than 0.5% of it.
  std::vector<std::string> warnings(const std::string& file, int steps) const;

 private:
  // The largest errors that were found, in metres or degrees.
  struct Way {
    double length = 0;  // of the motion, from the opening on
    double miss = 0;    // beyond rounding errors

    void addPlaces(const vec3& opening, const vec3& moved, const vec3& truth);
    void addAngles(double fromOpening, double fromTruth);
  };
  Way vertices_, lamps_, lampTurn_, camera_, cameraTurn_;
};

}  // namespace chromeball
