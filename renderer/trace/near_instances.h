// SPDX-License-Identifier: Apache-2.0
// Triangles near a point, of meshes that are traced as instances.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace chromeball {

// Embree 3.13 searches an instance with the radius of world space, which misses triangles
// where a scale below 1 makes it less than the rounding of the instance's own coordinates. This
// searches the instances' boxes, and then each instance in its own space.
class NearInstances {
 public:
  struct Placed {
    uint32_t instance;  // index into Scene::instances
    RTCSceneTy* mesh;   // the structure of its mesh, in the mesh's space
  };

  // All arguments must outlive this.
  NearInstances(RTCDeviceTy* device, const Scene& scene, std::vector<Placed> placed);
  ~NearInstances();
  NearInstances(const NearInstances&) = delete;
  NearInstances& operator=(const NearInstances&) = delete;

  // As Accel::forEachNear(); returns false if visit() has ended the search.
  using Visit = bool (*)(uint32_t instance, uint32_t triangle, void* visitor);
  bool search(const vec3& point, float radius, float time, Visit visit, void* visitor) const;

 private:
  struct Search;

  const Scene& scene_;
  std::vector<Placed> placed_;
  RTCSceneTy* boxes_;
};

}  // namespace chromeball
