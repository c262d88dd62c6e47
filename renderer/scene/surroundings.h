// SPDX-License-Identifier: Apache-2.0
// Surroundings at a finite distance: a surface onto which the probe is projected (HDRI book,
// section 9.2.3).
#pragma once

#include <string>

#include "math/vec.h"

namespace chromeball {

// A surface around the scene and the point inside it where the probe was captured. Metres, world
// space. For Shape::Model the functions below do not apply; see Walls.
struct Surroundings {
  enum class Shape { Box, Sphere, Model };
  Shape shape = Shape::Box;
  vec3 min{0}, max{0};  // Box
  vec3 center{0};       // Sphere
  float radius = 0;
  std::string model;  // path of the model's file
  vec3 capture{0};    // the position at which the probe was captured

  struct Point {
    vec3 position;
    vec3 normal;  // unit, inwards
  };
  // The point at which a ray from inside hits the box or sphere; the ray's origin if that is
  // slightly outside.
  Point behind(const vec3& origin, const vec3& direction) const;

  bool contains(const vec3& point) const;
  void grow(float fraction);  // on each side, by this fraction of its size
};

// Surroundings of any other shape, such as a model of the room (trace/room.h).
class Walls {
 public:
  virtual ~Walls() = default;

  // The same as Surroundings::behind().
  virtual Surroundings::Point behind(const vec3& origin, const vec3& direction) const = 0;

  // Whether no wall hides a point returned by behind() from `from`.
  virtual bool isSeen(const vec3& point, const vec3& from) const = 0;
};

}  // namespace chromeball
