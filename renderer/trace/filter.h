// SPDX-License-Identifier: Apache-2.0
// The functions that Embree calls for each hit of a surface that may let light pass.
#pragma once

#include "math/vec.h"
#include "scene/scene.h"
#include "trace/embree.h"

namespace chromeball {

// The context of a ray, or of a packet of rays in scenes without filters.
struct Query {
  QueryContext embree;  // first, so that a filter can cast back
  uint32_t key = 0;     // of Accel::intersect()
  // Of a shadow ray:
  vec3 direction{0};
  float length = 0;           // may be infinite
  Rgb transmittance{1};       // of surfaces
  Rgb opticalDepth{0};        // of bodies
  Rgb attenuation{0};         // behind the hits so far, 1/m
  Rgb largestAttenuation{0};  // of the bodies so far, to judge rounding errors
};

// Index into Scene::instances. Geometry i of the top scene is instance i; one more geometry has the
// instances that do not move, under their own indices.
inline uint32_t instanceOf(const Scene& scene, uint32_t topInstance, uint32_t geometry) {
  return topInstance < scene.instances.size() ? topInstance : geometry;
}

// Ignores the hit with probability 1 - alpha.
void filterClosest(const RTCFilterFunctionNArguments* arguments);

// Multiplies Query::transmittance by that of the surface; ignores the hit unless it is now 0.
void filterShadow(const RTCFilterFunctionNArguments* arguments);

}  // namespace chromeball
