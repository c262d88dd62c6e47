// SPDX-License-Identifier: Apache-2.0
#include "transport/first_surface.h"

namespace chromeball {

Bsdf FirstSurface::bsdf(const PathTracer& tracer, const PathState& state) const {
  const World& world = tracer.world();
  const vec3 wo = -state.ray.direction;
  if (!surface.material->extended)
    return Bsdf(material, surface, wo, world.bsdfTables, tracer.mirrorAlpha());
  return Bsdf(material, extendedMaterialAt(world.scene, instance, surface),
              state.media.refractiveIndex(surface, state.throughput), surface, wo, world.bsdfTables,
              tracer.mirrorAlpha());
}

FirstHit firstHitAt(const Instance& instance, const vec3& normal, const Rgb& baseColor,
                    float length) {
  FirstHit first;
  first.hit = true;
  first.depth = length;
  first.albedo = first.seen = baseColor;
  first.normal = normal;
  first.material = instance.material, first.node = instance.node;
  return first;
}

std::optional<FirstSurface> firstSurface(const PathTracer& tracer, PathState& state,
                                         const std::optional<Hit>& hit, PathContext& context) {
  const auto visible = tracer.skipHiddenBacks(state, hit, context);
  if (!visible) return {};
  const Scene& scene = tracer.world().scene;
  const Instance& instance = scene.instances[visible->instance];
  state.length += visible->distance;
  const float crossSection = state.beam ? state.beam.crossSection(state.length) : 0;
  FirstSurface found(scene, *visible,
                     surfaceAt(scene, instance, visible->triangle, visible->barycentric,
                               -state.ray.direction, crossSection, state.ray.time));
  if (state.first)
    *state.first =
        firstHitAt(instance, found.surface.normal, found.material.baseColor, state.length);
  return found;
}

std::optional<FirstSurface> firstReflector(const PathTracer& tracer, PathState& state,
                                           const std::optional<Hit>& hit, PathContext& context,
                                           Rgb& radiance) {
  context.sampler.startVertex(0);
  const auto first = firstSurface(tracer, state, hit, context);
  if (!first) {
    tracer.vertex(state, std::nullopt, context);
    radiance += state.radiance;
    return {};
  }
  const Material& material = *first->surface.material;
  if (material.emits()) radiance += tracer.foundEmission(state, first->surface, first->hit);
  if (material.unlit) return {};
  return first;
}

}  // namespace chromeball
