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

// What the camera sees of the plane y = height, and the surroundings of the objects within three
// times the size of their box; nothing beyond 30 times that size and their distance from the camera
// together, from where no shadow or light of the objects is to be seen. Throws InputError, begun by
// `location`, if the camera is below the plane or does not see it.
Ground groundSeenBy(const Camera& camera, float aspectRatio, const Bounds& objects, float height,
                    const std::string& location);

// The name of the node that addGround() adds, which no node of a model has.
inline constexpr const char* kGroundNode = "[composite] ground";

// Adds the rectangle, matte. It lies lower by 1e-5 of the objects' size, so that surfaces of the
// model at its height are in front of it.
void addGround(Scene& scene, const Ground& ground, const Rgb& reflectance);

}  // namespace chromeball
