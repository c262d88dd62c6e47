// SPDX-License-Identifier: Apache-2.0
// The triangles of instances, at their places in the scene.
#pragma once

#include <array>
#include <utility>

#include "scene/scene.h"
#include "scene/surface.h"

namespace chromeball {

using Corners = std::array<glm::dvec3, 3>;

// Calls visit(corners) for the triangles of an instance from `begin` to `end`, with their corners
// counter-clockwise from the front.
template <class Visit>
void forTriangles(const Scene& scene, const Instance& instance, size_t begin, size_t end,
                  const Visit& visit) {
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  const bool mirrors = instance.mirrors();
  for (size_t i = begin; i < end; ++i) {
    const Triangle& triangle = mesh.triangles[i];
    Corners c;
    for (int k = 0; k < 3; ++k) c[size_t(k)] = instance.point(mesh.positions[triangle[k]]);
    if (mirrors) std::swap(c[1], c[2]);
    visit(c);
  }
}

inline size_t triangleCount(const Scene& scene, const Instance& instance) {
  return scene.meshes[size_t(instance.mesh)].triangles.size();
}

// The largest distance of surfaces that are meant to lie in one plane.

// An offset in metres, at least rayOffset(). The latter is almost 0 for a triangle in a coordinate
// plane, but the rotation of a node that turns another triangle into this plane has the rounding
// errors of all coordinates.
inline float planeOffset(const Scene& scene, const Instance& instance, uint32_t triangle,
                         const vec3& normal, float time) {
  constexpr float kAcross = 0.25f;
  return rayOffset(placedTriangle(scene, instance, triangle, time).sizes,
                   glm::abs(normal) + kAcross);
}

}  // namespace chromeball
