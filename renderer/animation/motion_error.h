// SPDX-License-Identifier: Apache-2.0
// How well keys follow the motion that they are taken from.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

class MotionError {
 public:
  // Compares what moves in `scene` at `time` with the scene as it is `then`.
  void add(const Scene& scene, const Scene& then, float time);
  void add(const Camera& camera, const Camera& then, float time);

  // The camera turns so far at constant speed while the shutter is open: from half a turn between
  // two keys on, these do not show its direction.
  void addTurn(double degrees, int steps);

  // A line for each of models, lamps and camera that misses its way by more than 0.5% of it.
  std::vector<std::string> warnings(const std::string& file, int steps) const;

 private:
  // The largest that were found, in metres or degrees.
  struct Way {
    double length = 0;  // from what there is at the opening
    double miss = 0;    // beyond rounding errors

    void addPlaces(const vec3& opening, const vec3& moved, const vec3& truth);
    void addAngles(double fromOpening, double fromTruth);
  };
  Way vertices_, lamps_, lampTurn_, camera_, cameraTurn_;
};

}  // namespace chromeball
