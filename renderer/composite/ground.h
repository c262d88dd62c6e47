// SPDX-License-Identifier: Apache-2.0
// The ground as a local scene that nobody has to model: a horizontal rectangle.
#pragma once

#include <vector>

#include "scene/bounds.h"
#include "scene/camera.h"

namespace chromeball {

struct Ground {
  float height = 0;  // metres
  vec2 min, max;     // x and z
};

// The plane y = height as far as 30 times the size of the objects' box and their distance from the
// camera together, on all sides: the ground behind the camera lights the objects too, and what lies
// beyond is within 2 degrees of their horizon. Throws InputError, begun by `location`, if the
// camera is below the plane or does not see it.
Ground groundAround(const Camera& camera, float aspectRatio, const Bounds& objects, float height,
                    const std::string& location);

// The name of the node that addGround() adds, which no node of a model has.
inline constexpr const char* kGroundNode = "[composite] ground";

// Adds the rectangle, matte. It lies lower by 1e-5 of the objects' size, so that surfaces of the
// model at its height are in front of it.
void addGround(Scene& scene, const Ground& ground, const Rgb& reflectance);

}  // namespace chromeball
