// Surroundings at a finite distance: the surface that a probe is mapped onto (HDRI book, 9.2.3).
#pragma once

#include "math/vec.h"

namespace chromeball {

// A closed convex surface around the scene, and the point inside it where the probe was captured.
// Metres, world space.
struct Surroundings {
  enum class Shape { Box, Sphere };
  Shape shape = Shape::Box;
  vec3 min{0}, max{0};  // Box
  vec3 center{0};       // Sphere
  float radius = 0;
  vec3 capture{0};

  struct Point {
    vec3 position;
    vec3 normal;  // unit, inwards
  };
  // Where a ray from inside meets the surface; one that starts a little outside, at its start.
  Point behind(const vec3& origin, const vec3& direction) const;

  bool contains(const vec3& point) const;
  void move(const vec3& by);
  void grow(float share);  // of its size, to all sides
};

}  // namespace chromeball
