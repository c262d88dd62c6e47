// SPDX-License-Identifier: Apache-2.0
// PathTracer: whether a ray escapes, and the light that it finds then.
#include <algorithm>

#include "trace/accel.h"
#include "transport/light_groups.h"
#include "transport/path.h"
#include "transport/path_settings.h"

namespace chromeball {

bool PathTracer::surfacesEndPaths(const World& world) {
  return !world.accel.hasFilter() &&
         std::ranges::none_of(world.scene.materials, [](const Material& m) {
           return m.emits() || m.extended || m.backLetsLightThrough();
         });
}

bool PathTracer::endsAtAnyHit(const PathState& state, const PathContext& context) const {
  return surfacesEndPaths_ && state.bounces() == settings_.maxDepth && !state.isDelta &&
         !state.place && !state.first &&
         (!settings_.estimateDepthCut || state.cutIsEstimated ||
          !isFollowed(DepthLimit::Depth, context.sampler.sampleKey()));
}

bool PathTracer::escapes(const Ray& ray, PathContext& context) const {
  if (context.log) context.log->rays.push_back({ray, true});
  return !isBlack(world_.accel.transmittance(ray, settings_.visible));
}

void PathTracer::addBackground(PathState& state, const Rgb& background,
                               PathContext& context) const {
  Rgb found(0);
  if (state.depth > 0 || !settings_.hideProbe) {
    if (context.groups) [[unlikely]]
      context.groups->addBackground(lighting_, {}, state.ray.origin, state.ray.direction,
                                    state.throughput);
    found = state.throughput * background + distantRadiance(state, context);
  }
  if (state.first) [[unlikely]]
    seen_.noteEscaped(state, found);
  state.radiance += found;
}

// Light from World::sources, which light narrow lobes too: only the camera, and what it sees by
// delta lobes, sees background(). After a bounce that is not delta, a delta lobe (glass before the
// light) finds all of the light, which light samples cannot serve.
Rgb PathTracer::distantRadiance(const PathState& state, PathContext& context) const {
  const vec3 &origin = state.ray.origin, &direction = state.ray.direction;
  Rgb sum(0);
  for (const size_t i : world_.sources.distant) {
    const LightSource& source = *world_.sources.all[i];
    if (!state.scattered) {
      sum += state.throughput * source.background(origin, direction);
      if (context.groups) [[unlikely]]
        context.groups->addBackground(source, i, origin, direction, state.throughput);
      continue;
    }
    const LightSource::Escaped found = source.escaped(state.from, direction);
    if (isBlack(found.radiance)) continue;
    const Rgb weight = state.throughput *
                       (state.isDelta ? 1 : bsdfSampleWeight(settings_.mis, state.pdf, found.pdf));
    sum += weight * found.radiance;
    if (context.groups) [[unlikely]]
      context.groups->addEscaped(source, i, state.from, direction, weight);
  }
  return sum;
}

Rgb PathTracer::weighted(const PathState& state, const LightSource::Escaped& escaped,
                         PathContext& context) const {
  const Rgb found = state.throughput * escaped.radiance;
  const vec3& direction = state.ray.direction;
  const float lightPdf = state.region ? state.region->pdf(escaped.pdf, direction) : escaped.pdf;
  const float weight = state.isDelta ? 1 : bsdfSampleWeight(settings_.mis, state.pdf, lightPdf);
  if (context.groups) [[unlikely]]
    context.groups->addEscaped(lighting_, {}, state.from, direction, state.throughput * weight);
  if (state.isDelta) return found;
  if (context.records) {
    const float integrand = luminance(found) / luminance(state.throughputBefore) * state.pdf;
    context.addRecord({state.from.position, state.from.normal, direction, integrand,
                       lightPdf + state.pdf, escaped.pdf, state.pdf});
  }
  return found * weight;
}

void PathTracer::addEscaped(PathState& state, const LightSource::Escaped& escaped,
                            PathContext& context) const {
  state.radiance += weighted(state, escaped, context) + distantRadiance(state, context);
}

}  // namespace chromeball
