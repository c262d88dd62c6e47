// SPDX-License-Identifier: Apache-2.0
// Surroundings at a finite distance: the surface that a probe is mapped onto (HDRI book, 9.2.3).
#pragma once

#include <string>

#include "math/vec.h"

namespace chromeball {

// A surface around the scene, and the point inside it where the probe was captured. Metres, world
// space. A model of the room is answered for by its walls.
struct Surroundings {
  enum class Shape { Box, Sphere, Model };
  Shape shape = Shape::Box;
  vec3 min{0}, max{0};  // Box
  vec3 center{0};       // Sphere
  float radius = 0;
  std::string model;  // path of its file
  vec3 capture{0};

  struct Point {
    vec3 position;
    vec3 normal;  // unit, inwards
  };
  // Where a ray from inside meets the box or sphere; one that starts a little outside, at its
  // start.
  Point behind(const vec3& origin, const vec3& direction) const;

  bool contains(const vec3& point) const;
  void move(const vec3& by);
  void grow(float fraction);  // of its size, to all sides
};

// Surroundings of any shape (trace/room.h).
class Walls {
 public:
  virtual ~Walls() = default;

  // As Surroundings::behind().
  virtual Surroundings::Point behind(const vec3& origin, const vec3& direction) const = 0;

  // Whether a point that behind() found is seen from `from`, as far as the walls are concerned.
  virtual bool isSeen(const vec3& point, const vec3& from) const = 0;
};

}  // namespace chromeball
