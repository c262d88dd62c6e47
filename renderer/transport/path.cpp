// SPDX-License-Identifier: Apache-2.0
#include "transport/path.h"

#include <cmath>
#include <utility>

#include "trace/accel.h"
#include "transport/first_surface.h"
#include "transport/light_groups.h"
#include "transport/pass_through.h"
#include "transport/path_settings.h"

namespace chromeball {
namespace {

// Whether the medium at the start of a shadow ray to the probe matters: if so, the ray cannot wait
// for the shadow rays of other paths.
bool needsMedium(const Accel& accel, const PathState& state, const Surface& surface) {
  return state.place ||
         (accel.needsMedia() && (state.media.inside() || surface.material->isBody()));
}

// Whether maxTransmissionDepth limits the bounce: all bounces at a solid body, except reflection
// from the outside of a rough surface.
bool isTransmission(const Surface& surface, const BsdfSample& bounce) {
  return surface.material->isBody() &&
         (bounce.isDelta || !surface.frontFace || glm::dot(surface.geometricNormal, bounce.wi) < 0);
}

void countKind(PathState& state, bool isTransmission, bool isDiffuse) {
  if (isTransmission) return;
  ++(isDiffuse ? state.diffuse : state.specular);
}

}  // namespace

PathTracer::PathTracer(const World& world, const LightSource& lighting,
                       const PathSettings& settings)
    : world_(world),
      lighting_(lighting),
      settings_(settings),
      mirrorAlpha_(lighting.mirrorAlpha()),
      limitsKinds_(settings.limitsKinds()),
      surfacesEndPaths_(surfacesEndPaths(world)),
      seen_(world, lighting),
      direct_(world, lighting, settings) {}

PathTracer::PathTracer(const PathTracer& other, const PathSettings& settings)
    : world_(other.world_),
      lighting_(other.lighting_),
      settings_(settings),
      mirrorAlpha_(other.mirrorAlpha_),
      limitsKinds_(settings.limitsKinds()),
      surfacesEndPaths_(other.surfacesEndPaths_),
      seen_(other.seen_),
      direct_(world_, lighting_, settings) {}

std::optional<Hit> PathTracer::closestHit(const Ray& ray, PathContext& context) const {
  if (context.log) context.log->rays.push_back({ray, false});
  Hit hit;
  if (!world_.accel.intersect(ray, context.sampler.sampleKey(), hit, settings_.visible))
    return std::nullopt;
  return hit;
}

std::optional<Hit> PathTracer::nextHit(const PathState& state, PathContext& context) const {
  if (!state.place) return closestHit(state.ray, context);
  Hit hit = state.place.current();
  hit.distance = 0;
  return hit;
}

Surface PathTracer::surfaceOf(const PathState& state, const Hit& hit) const {
  // Rough reflection does not widen the beam; textures seen by reflection stay sharp.
  const float crossSection = state.beam ? state.beam.crossSection(state.length) : 0;
  Surface surface = surfaceAt(world_.scene, world_.scene.instances[hit.instance], hit.triangle,
                              hit.barycentric, -state.ray.direction, crossSection, state.ray.time);
  if (sharesPlace(hit)) [[unlikely]]
    surface.rayOffset = offsetAtPlace(world_.scene, surface, hit);
  if (state.place) [[unlikely]]
    surface.rayOffset = std::max(surface.rayOffset, state.place.rayOffset);
  return surface;
}

void PathState::leave(const Surface& surface, const vec3& wi) {
  ray = rayFrom(surface, wi);
  place.leave(wi);
}

Rgb PathTracer::foundEmission(const PathState& state, const Surface& surface,
                              const Hit& hit) const {
  return state.throughput * foundEmission(state.from, state.isDelta ? 0 : state.pdf,
                                          state.ray.direction, surface, hit);
}

Rgb PathTracer::foundEmission(const LightPoint& from, float pdf, const vec3& direction,
                              const Surface& surface, const Hit& hit) const {
  const Instance& instance = world_.scene.instances[hit.instance];
  if (surface.material->unlit || pdf == 0)
    return emittedRadiance(world_.scene, instance, surface, -direction);
  float lightPdf = 0;
  for (const auto& source : world_.sources.all) {
    if (source->knowsAsBlack(hit.instance, hit.triangle)) return Rgb(0);
    lightPdf += source->pdfOfHit(from, surface, hit.instance, hit.triangle);
  }
  // A texture filter would have light where light samples find none.
  Surface unfiltered = surface;
  unfiltered.footprint = 0;
  return emittedRadiance(world_.scene, instance, unfiltered, -direction) *
         bsdfSampleWeight(settings_.mis, pdf, lightPdf);
}

const CausticGuide* PathTracer::guideOf(const PathState& state) const {
  return state.guideRatio < kLeastGuideRatio ? nullptr : settings_.caustics;
}

// Notes a bounce that the guide might have chosen. The light found after the first one is recorded.
void PathTracer::noteGuided(PathState& state, const GuidedBsdf::Bounce& bounce,
                            const PathContext& context) {
  state.guideRatio = std::min(state.guideRatio * bounce.ratio, kLargestGuideRatio);
  if (context.records && bounce.lobesPdf > 0 && state.guided.record.lobesPdf == 0)
    state.guided = {{0, bounce.lobesPdf, bounce.bsdfPdf, bounce.fraction}, {}, true};
}

template <bool kLayered>
bool PathTracer::scatterAs(PathState& state, const Surface& surface, const Bsdf& bsdf,
                           PathContext& context) const {
  const PixelSampler& sampler = context.sampler;
  // At the limit only smooth solids transmit light; light samples could not find that.
  const bool atLimit = state.bounces() == settings_.maxDepth;
  const LightPoint before = state.from;
  const GuideRegion* const regionBefore = state.region;
  state.from = {surface.position, bsdf.normal(),    &bsdf,
                state.depth,      bsdf.transmits(), surface.time};
  state.region = nullptr;
  const GuidedBsdf guided(bsdf, surface.position, -state.ray.direction, guideOf(state));
  if (!atLimit) {
    const bool broad = bsdf.has(Lobes::Broad);
    if (settings_.guide && broad)
      state.region = settings_.guide->find(surface.position, bsdf.normal());
    const Vertex vertex{state.from,   surface,          guided,      state.media,
                        state.region, state.throughput, &state.place};
    if (broad && state.deferred && !needsMedium(world_.accel, state, surface))
      direct_.defer(vertex, state.throughput, *state.deferred, context);
    else if (broad)
      state.radiance += state.throughput * direct_.probe(vertex, context);
    if (broad || bsdf.has(Lobes::Narrow))
      for (size_t i = 0; i < world_.sources.all.size(); ++i)
        state.radiance += state.throughput * direct_.ofScene(i, vertex, context);
  }
  state.from.bsdf = nullptr;  // its lifetime ends with the vertex

  GuidedBsdf::Bounce next;
  if (!guided.sample(sampler, next)) return false;
  if constexpr (kLayered) {
    const bool transmission = isTransmission(surface, next);
    const bool ends = transmission ? state.transmissions == settings_.maxTransmissionDepth ||
                                         (atLimit && !next.isDelta)
                                   : atLimit;
    if (ends) return false;
    state.transmissions += transmission;
  }
  const Rgb throughputBefore = state.throughput;
  state.throughput *= next.weight;
  if (settings_.caustics) noteGuided(state, next, context);
  if (!survivesRoulette(state.throughput, state.guideRatio, state.depth, sampler)) return false;
  ++state.depth;
  ++context.counts.bounce;
  if constexpr (kLayered) {
    state.media.follow(surface, next.wi);
    if (next.wi == state.ray.direction && goesStraight(state, *surface.material)) {
      state.from = before;
      state.region = regionBefore;
      passStraight(state, surface);
      return true;
    }
  }
  state.scattered |= !next.isDelta;
  if (limitsKinds_ && next.wi != state.ray.direction) [[unlikely]]
    countKind(state, isTransmission(surface, next), next.isDiffuse);
  if (state.widening > 0 && !next.isDelta)
    state.minAlpha = std::max(state.minAlpha, state.widening * spreadOf(next.bsdfPdf));
  state.throughputBefore = throughputBefore;
  state.pdf = next.pdf;
  state.isDelta = next.isDelta;
  state.lobes = next.lobes;
  state.leave(surface, next.wi);
  return true;
}

bool PathTracer::scatter(PathState& state, const Surface& surface, const Bsdf& bsdf,
                         PathContext& context) const {
  Bsdf limited = bsdf;
  const bool isBody = bsdf.isLayered() && surface.material->isBody();
  if (limitsKinds_ && !limitKinds(state, limited) && !isBody) return false;
  if (bsdf.isLayered()) return scatterAs<true>(state, surface, limited, context);
  return state.bounces() < settings_.maxDepth && scatterAs<false>(state, surface, limited, context);
}

ExtendedPoint PathTracer::extendedPointAt(const PathState& state, const Instance& instance,
                                          const Surface& surface) const {
  ExtendedPoint point = extendedMaterialAt(world_.scene, instance, surface);
  if (goesStraight(state, *surface.material)) point.thinWalled = true;
  return point;
}

// Not inlined, so that layered materials do not slow down plain ones.
[[gnu::noinline]] bool PathTracer::scatterLayered(PathState& state, const Instance& instance,
                                                  const Surface& surface,
                                                  const MaterialPoint& material,
                                                  PathContext& context) const {
  Bsdf bsdf(material, extendedPointAt(state, instance, surface),
            state.media.refractiveIndex(surface, state.throughput), surface, -state.ray.direction,
            world_.bsdfTables, mirrorAlpha_);
  // Bodies have their own limit, and a straight passage through a sheet is no bounce.
  if (limitsKinds_ && !limitKinds(state, bsdf) && surface.material->extended->transmission == 0)
    return false;
  return scatterAs<true>(state, surface, bsdf, context);
}

bool PathTracer::vertex(PathState& state, const std::optional<Hit>& hit,
                        PathContext& context) const {
  if (!hit) {
    if (state.lobes == Lobes::Narrow)
      addBackground(state, lighting_.background(state.ray.origin, state.ray.direction), context);
    else
      addEscaped(state, lighting_.escaped(state.from, state.ray.direction), context);
    return false;
  }
  state.length += hit->distance;
  if (state.media.inside()) state.throughput *= state.media.transmittance(hit->distance);
  const Scene& scene = world_.scene;
  const Instance& instance = scene.instances[hit->instance];
  const Surface surface = surfaceOf(state, *hit);
  if (!state.place && (mayPass(state, surface) || sharesPlace(*hit))) [[unlikely]] {
    float weight = 1;
    auto met = metAt(state, *hit, surface, weight, context);
    if (met && !state.place && passesFromBehind(state, *surface.material, surface.frontFace)) {
      weight = 2;
      if (continuesBehind(*hit, context.sampler)) met.reset();
    }
    state.throughput *= weight;
    if (!met) {
      state.leave(surface, state.ray.direction);
      return true;
    }
    met->distance = 0;  // the path has come to it
    if (state.place) return vertex(state, met, context);
  }
  if (surface.material->emits()) {
    const Rgb found = foundEmission(state, surface, *hit);
    state.radiance += found;
    if (context.groups) [[unlikely]]
      context.groups->addEmitted(instance, found);
  }
  if (state.first && state.lobes != Lobes::Narrow && !state.first->direct) [[unlikely]]
    state.first->direct = state.radiance;
  const bool ends = surface.material->unlit ||
                    (state.bounces() == settings_.maxDepth && !surface.material->isBody());
  const bool isFirst = state.first && state.depth == 0;
  if (ends && !isFirst) return passAtLimit(scene, state, instance, surface);

  MaterialPoint material = materialAt(scene, surface);
  if (isFirst)
    *state.first = firstHitAt(instance, surface.normal, material.baseColor, state.length);
  else if (state.first) [[unlikely]]
    SeenFeature::noteSurface(state, material);
  if (ends) return passAtLimit(scene, state, instance, surface);
  if (state.minAlpha > 0 && !goesStraight(state, *surface.material)) [[unlikely]]
    widen(material, state.minAlpha);
  if (surface.material->extended) [[unlikely]]
    return scatterLayered(state, instance, surface, material, context);
  Bsdf bsdf(material, surface, -state.ray.direction, world_.bsdfTables, mirrorAlpha_);
  if (limitsKinds_ && !limitKinds(state, bsdf)) [[unlikely]]
    return false;
  return scatterAs<false>(state, surface, bsdf, context);
}

Rgb PathTracer::follow(PathState state, std::optional<Hit> hit, PathContext& context) const {
  context.sampler.startVertex(state.depth);
  for (;;) {
    estimateDepthCut(state, hit, context);
    if (!vertex(state, hit, context)) break;
    context.sampler.startVertex(state.depth);
    state.guided.startRest(state.radiance);
    if (endsAtAnyHit(state, context)) {
      if (!escapes(state.ray, context)) break;
      hit.reset();
    } else {
      hit = nextHit(state, context);
    }
  }
  context.addRecord(state.guided, state.radiance);
  return state.radiance;
}

Rgb PathTracer::reflected(PathState state, const Surface& surface, const Bsdf& bsdf,
                          PathContext& context) const {
  const bool goesOn = scatter(state, surface, bsdf, context);
  const Rgb found = std::exchange(state.radiance, Rgb(0));
  if (!goesOn) return found;
  context.sampler.startVertex(state.depth);
  state.first = nullptr;
  return found + follow(state, nextHit(state, context), context);
}

Rgb PathTracer::radiance(const PathState& start, const std::optional<Hit>& hit,
                         PathContext& context) const {
  ++context.counts.camera;
  const Rgb found = follow(start, hit, context);
  context.depthCut.addFound(found);
  return found;
}

}  // namespace chromeball
