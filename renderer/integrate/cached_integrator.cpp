// SPDX-License-Identifier: Apache-2.0
#include "integrate/cached_integrator.h"

#include "integrate/fill_cache.h"
#include "integrate/first_surface.h"
#include "integrate/gather_irradiance.h"

namespace chromeball {

CachedIntegrator::CachedIntegrator(const PathTracer& tracer, const IrradianceCache& cache)
    : tracer_(tracer),
      direct_(tracer.world(), tracer.lighting(), sourcesAlone(tracer.settings())),
      cache_(cache) {}

Sample CachedIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  context.sampler.startVertex(0);
  PathState state = camera.path();
  const auto first = firstSurface(tracer_, state, camera.hit, context);
  if (!first || !hasRecords(*first->surface.material))
    return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  const Bsdf bsdf = first->bsdf(tracer_, state);
  const auto diffuse = cached(bsdf, first->surface);
  if (!diffuse) return context.clamp(tracer_.radiance(camera.path(), camera.hit, context));
  ++context.counts.camera;
  Rgb radiance = *diffuse;
  if (first->surface.material->emits())
    radiance += tracer_.foundEmission(state, first->surface, first->instance);
  Bsdf diffuseLobes = bsdf, otherLobes = bsdf;
  diffuseLobes.keepOnly({.diffuse = true, .specular = false});
  otherLobes.keepOnly({.diffuse = false, .specular = true});
  radiance += direct_.reflected(state, first->surface, diffuseLobes, context);
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
