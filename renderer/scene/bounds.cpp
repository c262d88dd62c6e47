// SPDX-License-Identifier: Apache-2.0
#include "scene/bounds.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

template <class Place>
Bounds boundsOf(const std::vector<vec3>& points, const Place& place) {
  return joinRanges(
      points.size(), kElementsOfTask, Bounds(),
      [&](size_t begin, size_t end, Bounds& box) {
        for (size_t i = begin; i < end; ++i) box.add(place(points[i]));
      },
      [](Bounds& box, const Bounds& other) { box.add(other); });
}

}  // namespace

Bounds bounds(const std::vector<vec3>& points) {
  return boundsOf(points, [](const vec3& p) { return p; });
}

Bounds bounds(const Scene& scene, const Instance& instance) {
  return boundsOf(scene.meshes[size_t(instance.mesh)].positions,
                  [&](const vec3& p) { return instance.point(p); });
}

Bounds bounds(const Scene& scene, const std::vector<int>& instances) {
  Bounds box;
  for (const int i : instances) box.add(bounds(scene, scene.instances[size_t(i)]));
  return box;
}

Bounds bounds(const Scene& scene) {
  Bounds box;
  for (const Instance& instance : scene.instances) box.add(bounds(scene, instance));
  return box;
}

}  // namespace chromeball
