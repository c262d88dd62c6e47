// SPDX-License-Identifier: Apache-2.0
#include "integrate/cached_integrator.h"

#include "integrate/first_surface.h"

namespace chromeball {
namespace {

PathSettings directOnly(PathSettings settings) {
  settings.maxDepth = std::min(settings.maxDepth, 1);
  return settings;
}

}  // namespace

CachedIntegrator::CachedIntegrator(const PathTracer& tracer, const IrradianceCache& cache)
    : tracer_(tracer),
      direct_(tracer.world(), tracer.lighting(), directOnly(tracer.settings())),
      cache_(cache) {}

Sample CachedIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  ++context.counts.camera;
  PathState state = camera.path();
  Rgb radiance(0);
  const auto first = firstReflector(tracer_, state, camera.hit, context, radiance);
  if (!first) return context.clamp(radiance);
  const Bsdf bsdf = first->bsdf(tracer_, state);
  const auto diffuse = cached(bsdf, first->surface);
  if (!diffuse) {
    radiance += tracer_.reflected(state, first->surface, bsdf, context);
    return context.clamp(radiance);
  }
  Bsdf diffuseLobes = bsdf, otherLobes = bsdf;
  diffuseLobes.keepOnly({.diffuse = true, .specular = false});
  otherLobes.keepOnly({.diffuse = false, .specular = true});
  radiance += *diffuse + direct_.reflected(state, first->surface, diffuseLobes, context);
  context.sampler.startVertex(0);
  radiance += tracer_.reflected(state, first->surface, otherLobes, context);
  return context.clamp(radiance);
}

std::optional<Rgb> CachedIntegrator::cached(const Bsdf& bsdf, const Surface& surface) const {
  std::optional<Rgb> sum;
  for (const MapLobe& lobe : bsdf.mapLobes()) {
    if (!lobe.isDiffuse || isBlack(lobe.albedo)) continue;
    const auto irradiance = cache_.find(surface.position, lobe.direction);
    if (!irradiance) return {};
    sum = sum.value_or(Rgb(0)) + lobe.albedo * kInvPi * *irradiance;
  }
  return sum;
}

}  // namespace chromeball
