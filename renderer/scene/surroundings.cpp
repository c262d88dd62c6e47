// SPDX-License-Identifier: Apache-2.0
#include "scene/surroundings.h"

namespace chromeball {

Surroundings::Point Surroundings::behind(const vec3& origin, const vec3& direction) const {
  if (shape == Shape::Sphere) {
    // |o + t d|^2 = r^2 about the centre; the farther root.
    const vec3 o = origin - center;
    const float b = glm::dot(o, direction);
    const vec3 nearest = o - b * direction;
    const float reach2 = std::max(radius * radius - glm::dot(nearest, nearest), 0.0f);
    const vec3 position = nearest + std::sqrt(reach2) * direction;
    return {center + position, -glm::normalize(position)};
  }
  float distance = INFINITY;
  int wall = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const float to = direction[axis] > 0 ? max[axis] : min[axis];
    const float t = std::max((to - origin[axis]) / direction[axis], 0.0f);
    if (t < distance) distance = t, wall = axis;
  }
  vec3 normal(0);
  normal[wall] = direction[wall] > 0 ? -1.0f : 1.0f;
  vec3 position = origin + distance * direction;
  position[wall] = direction[wall] > 0 ? max[wall] : min[wall];
  return {position, normal};
}

void Surroundings::grow(float fraction) {
  const vec3 margin = fraction * (max - min);
  min -= margin, max += margin;
  radius += fraction * radius;
}

bool Surroundings::contains(const vec3& p) const {
  if (shape == Shape::Sphere) return glm::length(p - center) < radius;
  return glm::all(glm::lessThan(min, p)) && glm::all(glm::lessThan(p, max));
}

}  // namespace chromeball
