// SPDX-License-Identifier: Apache-2.0
#include "approximate/occlusion.h"

#include "math/vec.h"
#include "math/warp.h"
#include "trace/accel.h"
#include "transport/context.h"
#include "transport/world.h"

namespace chromeball {
namespace {

SkyRay traced(const World& world, const Surface& surface, const vec3& direction, float distance,
              RayMask visible, PathContext& context) {
  if (glm::dot(surface.geometricNormal, direction) <= 0) return {direction, Rgb(0)};
  ++context.counts.shadow;
  return {direction, world.accel.transmittance(rayFrom(surface, direction, distance), visible)};
}

}  // namespace

SkyRay cosineSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                    RayMask visible, PathContext& context) {
  const vec3 local = squareToCosineHemisphere(context.sampler.get2(dimension::kLight));
  return traced(world, surface, Frame(normal).toWorld(local), distance, visible, context);
}

SkyRay uniformSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                     RayMask visible, PathContext& context) {
  const vec3 local = squareToUniformHemisphere(context.sampler.get2(dimension::kLight));
  return traced(world, surface, Frame(normal).toWorld(local), distance, visible, context);
}

}  // namespace chromeball
