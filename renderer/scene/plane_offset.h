// SPDX-License-Identifier: Apache-2.0
// How far apart surfaces may be that are meant to lie in one plane.
#pragma once

#include "scene/surface.h"

namespace chromeball {

// At least rayOffset(), metres. That is almost 0 for a triangle in a coordinate plane, but the
// rotation of a node that turns another triangle into this plane has the rounding errors of all
// coordinates.
inline float planeOffset(const Scene& scene, const Instance& instance, uint32_t triangle,
                         const vec3& normal, float time) {
  constexpr float kAcross = 0.25f;
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  const auto [p0, p1, p2] = cornersAt(scene, instance, mesh.triangles[triangle], time);
  return rayOffset(p0, p1, p2, glm::abs(normal) + kAcross);
}

}  // namespace chromeball
