// SPDX-License-Identifier: Apache-2.0
#include "approximate/occlusion.h"

#include <algorithm>
#include <utility>

#include "math/vec.h"
#include "math/warp.h"
#include "trace/accel.h"
#include "transport/camera_samples.h"
#include "transport/context.h"
#include "transport/first_surface.h"
#include "transport/world.h"

namespace chromeball {
namespace {

SkyRay traced(const World& world, const Surface& surface, const vec3& direction, float distance,
              RayMask visible, PathContext& context) {
  if (glm::dot(surface.geometricNormal, direction) <= 0) return {direction, Rgb(0)};
  ++context.counts.shadow;
  return {direction, world.accel.transmittance(rayFrom(surface, direction, distance), visible)};
}

// A sky ray with constant density over the hemisphere.
SkyRay uniformSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                     RayMask visible, PathContext& context) {
  const vec3 local = squareToUniformHemisphere(context.sampler.get2(dimension::kLight));
  return traced(world, surface, Frame(normal).toWorld(local), distance, visible, context);
}

}  // namespace

SkyRay cosineSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                    RayMask visible, PathContext& context) {
  const vec3 local = squareToCosineHemisphere(context.sampler.get2(dimension::kLight));
  return traced(world, surface, Frame(normal).toWorld(local), distance, visible, context);
}

namespace {

PathSettings ofALayer(PathSettings settings) {
  settings.estimateDepthCut = false;
  return settings;
}

bool contains(std::span<const Aov> wanted, Aov aov) {
  return std::ranges::find(wanted, aov) != wanted.end();
}

}  // namespace

SurfaceLayers::SurfaceLayers(const Integrator& picture, const PathTracer& tracer,
                             std::span<const Aov> wanted, const Occlusion& occlusion)
    : picture_(picture),
      tracer_(tracer.world(), tracer.lighting(), ofALayer(tracer.settings())),
      occlusion_(occlusion),
      wantsOcclusion_(contains(wanted, Aov::AmbientOcclusion)),
      wantsBent_(contains(wanted, Aov::BentNormal)),
      wantsIrradiance_(contains(wanted, Aov::Irradiance)) {}

void SurfaceLayers::sampleMany(const CameraSamples& cameras, PathContext& context,
                               std::span<Sample> samples) const {
  picture_.sampleMany(cameras, context, samples);
  for (size_t i = 0; i < cameras.size(); ++i) {
    const CameraSample camera = cameras[i];
    camera.start(context.sampler);
    const auto defect = measure(camera, context);
    if (!samples[i].defect) samples[i].defect = defect;
  }
}

std::optional<Defect> SurfaceLayers::measure(const CameraSample& camera,
                                             PathContext& context) const {
  context.sampler.startVertex(0);
  PathState state = camera.path();
  state.first = nullptr;
  const auto found = firstSurface(tracer_, state, camera.hit, context);
  if (!found) return {};
  FirstHit& first = *camera.first;
  const World& world = tracer_.world();
  const Surface& surface = found->surface;
  const RayMask visible = tracer_.settings().visible;
  SkyRay ray{};
  if (wantsOcclusion_ || (wantsBent_ && !occlusion_.uniformBent))
    ray = cosineSkyRay(world, surface, surface.normal, occlusion_.distance, visible, context);
  first.ambientOcclusion = luminance(ray.transmittance);
  if (wantsBent_ && occlusion_.uniformBent)
    ray = uniformSkyRay(world, surface, surface.normal, occlusion_.distance, visible, context);
  first.unoccluded = luminance(ray.transmittance) * ray.direction;
  if (!wantsIrradiance_) return {};
  const MaterialPoint white{Rgb(1), 0, 1, Rgb(0), 0};
  const Bsdf bsdf(white, surface, -state.ray.direction, world.bsdfTables);
  const auto records = std::exchange(context.records, nullptr);
  const Rgb irradiance = kPi * tracer_.reflected(state, surface, bsdf, context);
  context.records = records;
  const auto defect = defectOf(irradiance, false);
  if (!defect) first.irradiance = irradiance;
  return defect;
}

}  // namespace chromeball
