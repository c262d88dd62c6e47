// SPDX-License-Identifier: Apache-2.0
// The functions that Embree calls for each hit of a surface that may let light pass.
#pragma once

#include <span>

#include "math/vec.h"
#include "scene/scene.h"
#include "trace/embree.h"
#include "trace/ray.h"

namespace chromeball {

// The context of a ray, or of a packet of rays in scenes without filters.
struct Query {
  QueryContext embree;  // first, so that a filter can cast back
  uint32_t key = 0;     // of Accel::intersect()
  vec3 direction{0};
  // These are for shadow rays:
  float length = 0;                         // may be infinite
  Rgb transmittance{1};                     // of surfaces
  Rgb opticalDepth{0};                      // of bodies
  Rgb attenuation{0};                       // behind the hits so far, 1/m
  Rgb largestAttenuation{0};                // of the bodies so far, to judge rounding errors
  std::span<const Material* const> inside;  // the bodies that contain the origin
};

// Index into Scene::instances. Geometry i of the top scene is instance i; one more geometry has the
// instances that do not move, under their own indices.
inline uint32_t instanceOf(const Scene& scene, uint32_t topInstance, uint32_t geometry) {
  return topInstance < scene.instances.size() ? topInstance : geometry;
}

// Whether a ray meets a surface that it hits: with probability alpha. A ray meets a body as a whole
// or not at all: its coverage is decided where the ray enters, and the ray always meets the back,
// which is ignored if the ray is not inside (Media::ignores).
bool isCovered(const Scene& scene, const Hit& hit, const vec3& direction, float time, uint32_t key);

// Ignores the hit unless isCovered().
void filterClosest(const RTCFilterFunctionNArguments* arguments);

// Multiplies Query::transmittance by the surface's; ignores the hit unless it is now 0.
void filterShadow(const RTCFilterFunctionNArguments* arguments);

}  // namespace chromeball
