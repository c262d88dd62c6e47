// SPDX-License-Identifier: Apache-2.0
// The triangles of instances, at their places in the scene.
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/progress.h"
#include "scene/scene.h"
#include "scene/surface.h"

namespace chromeball {

using Corners = std::array<glm::dvec3, 3>;

// Calls visit(corners) for the triangles i x `step` of an instance, i from `begin` to `end`, with
// their corners counter-clockwise from the front.
template <class Visit>
void forTriangles(const Scene& scene, const Instance& instance, size_t begin, size_t end,
                  const Visit& visit, size_t step = 1) {
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  const bool mirrors = instance.mirrors();
  for (size_t i = begin; i < end; ++i) {
    const Triangle& triangle = mesh.triangles[i * step];
    Corners c;
    for (int k = 0; k < 3; ++k) c[size_t(k)] = instance.point(mesh.positions[triangle[k]]);
    if (mirrors) std::swap(c[1], c[2]);
    visit(c);
  }
}

inline size_t triangleCount(const Scene& scene, const Instance& instance) {
  return scene.meshes[size_t(instance.mesh)].triangles.size();
}

// What shows the shape of a model of many instances: all triangles, or some of each instance where
// all are too many to be looked at one by one.
struct ShownTriangles {
  size_t step, count;  // triangle i x step of the instance, i < count

  ShownTriangles(const Scene& scene, const Instance& instance, size_t instances) {
    constexpr size_t kMost = 1 << 22;  // of all instances
    const size_t all = triangleCount(scene, instance),
                 most = std::max<size_t>(kMost / instances, 1);
    step = std::max<size_t>((all + most - 1) / most, 1);
    count = (all + step - 1) / step;
  }
};

// Calls visit(corners, index) for the shown triangles of instances (indices into scene.instances).
template <class Visit>
void forShownTriangles(const Scene& scene, const std::vector<int>& instances, const Visit& visit) {
  for (const int i : instances) {
    endIfCancelled();
    const Instance& instance = scene.instances[size_t(i)];
    const ShownTriangles shown(scene, instance, instances.size());
    forTriangles(
        scene, instance, 0, shown.count, [&](const Corners& c) { visit(c, i); }, shown.step);
  }
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
