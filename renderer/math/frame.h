// SPDX-License-Identifier: Apache-2.0
// An orthonormal basis around a normal.
#pragma once

#include "math/vec.h"

namespace chromeball {

// Columns x, y, z of the rotation that takes local +z to the normal (Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited").
struct Frame {
  vec3 x, y, z;

  explicit Frame(const vec3& normal) : z(normal) {
    const float sign = std::copysign(1.0f, z.z);
    const float a = -1 / (sign + z.z), b = z.x * z.y * a;
    x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
    y = {b, sign + z.y * z.y * a, -z.y};
  }

  // With local +x along the component of the tangent that is perpendicular to the normal; any x if
  // there is none.
  Frame(const vec3& normal, const vec3& tangent) : Frame(normal) {
    const vec3 along = tangent - normal * glm::dot(normal, tangent);
    const float length2 = glm::dot(along, along);
    if (!(length2 > 1e-12f)) return;
    x = along / std::sqrt(length2);
    y = glm::cross(z, x);
  }

  vec3 toLocal(const vec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
  vec3 toWorld(const vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

}  // namespace chromeball
