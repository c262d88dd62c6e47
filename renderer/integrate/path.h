// SPDX-License-Identifier: Apache-2.0
// Radiance along one path: path tracing with next-event estimation and multiple importance
// sampling.
#pragma once

#include <climits>
#include <optional>
#include <vector>

#include "film/aov.h"
#include "integrate/direct_light.h"
#include "scene/thin_wall.h"
#include "shading/extended_bsdf.h"

namespace chromeball {

// Ends a path at random in proportion to what it can still carry; unbiased, since the survivors are
// raised by as much. The first two bounces always go on: they carry most of the picture.
inline bool survivesRoulette(Rgb& throughput, int depth, const PixelSampler& sampler) {
  if (depth < 2) return true;
  const float survival = std::min(maxComponent(throughput), 1.0f);
  if (sampler.get1(dimension::kRoulette) >= survival) return false;  // NaN goes on, to be counted
  throughput /= survival;
  return true;
}

template <class Rays>
std::optional<Hit> closestHit(const Rays& rays, const Ray& ray, const PixelSampler& sampler) {
  Hit hit;
  if (!rays.intersect(ray, sampler.sampleKey(), hit)) return std::nullopt;
  return hit;
}

// A path between two of its vertices, or before the first.
struct PathState {
  Ray ray;
  Rgb throughput{1};
  LightPoint from{};            // where the ray leaves; nowhere in particular for the camera's
  float pdf = 0;                // of the ray's direction at `from`; 0 for the camera and mirrors
  Lobes lobes = Lobes::Narrow;  // that chose the direction; the camera sees as mirrors do
  int depth = 0;                // of the vertex to come
  int straight = 0;             // vertices so far where the ray just went on; they are no bounces
  int transmissions = 0;    // bounces in and on bodies of glass, which have a limit of their own
  bool isMeasured = false;  // measureCut() has taken the path into account
  Media media;              // that the ray is in
  float length = 0;         // metres from the camera
  Beam beam{};              // around the camera's ray, where textures are filtered

  // Those that PathScene::maxDepth limits.
  int bounces() const { return depth - straight - transmissions; }
};

// Whether a bounce is one of light on its way through a body: all but what a rough surface throws
// back from outside.
inline bool isTransmission(const Surface& surface, const BsdfSample& bounce) {
  return surface.material->isBody() && (bounce.pdf == 0 || !surface.frontFace ||
                                        glm::dot(surface.geometricNormal, bounce.wi) < 0);
}

// Whether the path passes a surface as if it were not there: the camera and mirrors a hidden back.
inline bool isHiddenFrom(const PathState& state, const Surface& surface) {
  return state.pdf == 0 && !surface.frontFace && surface.material->hidesBack();
}

// Whether the path goes on to what lies behind a front. To what the front sends out, a surface that
// is there on one side only adds the light that meets its back; the path follows one of the two for
// both. Light samples pass the front as well, so that they still compete with the ray.
inline bool choosesBehind(PathState& state, const Surface& surface, const Hit& hit,
                          const PixelSampler& sampler) {
  if (state.pdf == 0 || !surface.frontFace || !surface.material->backLetsLightThrough())
    return false;
  constexpr uint64_t kPurpose = 0x6f6e6577;  // apart from other uses of the key
  state.throughput *= 2;
  return hash(sampler.sampleKey() ^ kPurpose, uint64_t(hit.instance) << 32 | hit.triangle) & 1;
}

// What the path finds where its ray meets nothing.
template <class Rays>
Rgb escapedRadiance(const PathScene<Rays>& path, const PathState& state) {
  const vec3 &origin = state.ray.origin, &direction = state.ray.direction;
  if (state.depth == 0 && path.hideProbe) return Rgb(0);
  if (state.lobes == Lobes::Narrow)
    return state.throughput * path.lighting.background(origin, direction);
  const auto escaped = path.lighting.escaped(state.from, direction);
  return state.throughput * escaped.radiance * bsdfSampleWeight(path.mis, state.pdf, escaped.pdf);
}

// What the path finds where its ray meets a surface that emits.
template <class Rays>
Rgb foundEmission(const PathScene<Rays>& path, const PathState& state, const Surface& surface,
                  const Instance& instance) {
  float pdf = 0;
  if (path.emitters && !surface.material->unlit)
    pdf = path.emitters->pdf(
        instance.material, glm::length(surface.position - state.from.position),
        std::max(-glm::dot(surface.geometricNormal, state.ray.direction), 1e-12f));
  return state.throughput * emittedRadiance(path.scene, instance, surface, -state.ray.direction) *
         bsdfSampleWeight(path.mis, state.pdf, pdf);
}

// Takes the path straight through a smooth sheet. Light samples at `from` see through it too, so
// that they still compete with the ray.
inline void goOn(PathState& state, const Surface& surface) {
  state.ray = {surface.rayOrigin(state.ray.direction), state.ray.direction};
  ++state.straight;
}

// Adds the light that comes straight to a vertex and chooses where the path goes on from there;
// false where it ends. Where bounces are used up, only a smooth body passes light on: its light
// samples find nothing that would be left out.
template <bool kExtended, class Rays>
bool scatter(const PathScene<Rays>& path, PathState& state, const Surface& surface,
             const Bsdf& bsdf, const PixelSampler& sampler, std::vector<DirectionSample>& samples,
             RayCounts& counts, Rgb& radiance) {
  const bool spent = state.bounces() == path.maxDepth;
  const LightPoint before = state.from;
  state.from = {surface.position, bsdf.normal(),   -state.ray.direction, &bsdf,
                state.depth,      bsdf.transmits()};
  const bool broad = bsdf.has(Lobes::Broad);
  if (broad && !spent)
    radiance += state.throughput * probeLight(path, state.from, surface, sampler, samples, counts);
  if ((broad || bsdf.has(Lobes::Narrow)) && !spent) {
    if (path.emitters)
      radiance +=
          state.throughput * emitterLight(path, state.from, surface, state.media, sampler, counts);
    if (path.punctual)
      radiance +=
          state.throughput * punctualLight(path, state.from, surface, state.media, sampler, counts);
  }
  state.from.bsdf = nullptr;  // it ends with the vertex

  BsdfSample next;
  if (!bsdf.sample(sampler.get2(dimension::kBsdf), sampler.get1(dimension::kLobe), next))
    return false;
  if constexpr (kExtended) {
    const bool transmission = isTransmission(surface, next);
    if (transmission ? state.transmissions == path.maxTransmissionDepth || (spent && next.pdf > 0)
                     : spent)
      return false;
    state.transmissions += transmission;
  }
  state.throughput *= next.weight;
  if (!survivesRoulette(state.throughput, state.depth, sampler)) return false;
  ++state.depth;
  ++counts.bounce;
  if constexpr (kExtended) {
    if (next.wi == state.ray.direction && passesStraight(*surface.material)) {
      state.from = before;
      goOn(state, surface);
      return true;
    }
    state.media.follow(surface, next.wi);
  }
  state.pdf = next.pdf;
  state.lobes = next.lobes;
  state.ray = {surface.rayOrigin(next.wi), next.wi};
  return true;
}

// The same for an extended material; out of line, so that plain ones do not feel its weight.
template <class Rays>
[[gnu::noinline]] bool scatterExtended(const PathScene<Rays>& path, PathState& state,
                                       const Instance& instance, const Surface& surface,
                                       const MaterialPoint& material, const PixelSampler& sampler,
                                       std::vector<DirectionSample>& samples, RayCounts& counts,
                                       Rgb& radiance) {
  const ExtendedBsdf extended(material, extendedMaterialAt(path.scene, instance, surface),
                              state.media.refractiveIndex(surface, state.throughput), surface,
                              -state.ray.direction, path.mirrorAlpha);
  return scatter<true>(path, state, surface, Bsdf(extended), sampler, samples, counts, radiance);
}

// Where bounces are used up, what passes straight through a surface still reaches the vertex
// before. False where nothing does.
inline bool passThrough(const Scene& scene, PathState& state, const Instance& instance,
                        const Surface& surface) {
  if (!surface.material->extended) return false;
  state.throughput *= straightTransmittance(scene, instance, surface, state.ray.direction);
  if (isBlack(state.throughput)) return false;
  ++state.depth;
  goOn(state, surface);
  return true;
}

// The vertex at `hit`: adds to `radiance` what is found there and moves the path on; false where it
// ends. `first` may be null.
template <class Rays>
bool pathVertex(const PathScene<Rays>& path, PathState& state, const std::optional<Hit>& hit,
                const PixelSampler& sampler, std::vector<DirectionSample>& samples,
                RayCounts& counts, FirstHit* first, Rgb& radiance) {
  if (!hit) {
    radiance += escapedRadiance(path, state);
    return false;
  }
  const Instance& instance = path.scene.instances[hit->instance];
  // Bounces leave the beam as it is: on rough surfaces it would widen, and what follows blur.
  state.length += hit->distance;
  const float crossSection = state.beam ? state.beam.crossSection(state.length) : 0;
  const Surface surface = surfaceAt(path.scene, instance, hit->triangle, hit->barycentric,
                                    -state.ray.direction, crossSection);
  if (state.media.inside()) state.throughput *= state.media.transmittance(hit->distance);
  if (isHiddenFrom(state, surface) || choosesBehind(state, surface, *hit, sampler)) [[unlikely]] {
    state.ray.origin = surface.rayOrigin(state.ray.direction);
    return true;
  }
  if (surface.material->emits()) radiance += foundEmission(path, state, surface, instance);
  const bool ends =
      surface.material->unlit || (state.bounces() == path.maxDepth && !surface.material->isBody());
  if (ends && !(first && state.depth == 0))
    return passThrough(path.scene, state, instance, surface);

  const MaterialPoint material = materialAt(path.scene, surface);
  if (first && state.depth == 0)
    *first = {true,           state.length,      material.baseColor,
              surface.normal, instance.material, instance.node};
  if (ends) return passThrough(path.scene, state, instance, surface);
  if (surface.material->extended) [[unlikely]]
    return scatterExtended(path, state, instance, surface, material, sampler, samples, counts,
                           radiance);
  const Bsdf bsdf(material, surface, -state.ray.direction, path.mirrorAlpha);
  return scatter<false>(path, state, surface, bsdf, sampler, samples, counts, radiance);
}

template <class Rays>
Rgb followPath(const PathScene<Rays>& path, PathState state, std::optional<Hit> hit,
               PixelSampler& sampler, std::vector<DirectionSample>& samples, RayCounts& counts,
               FirstHit* first);

// Estimates the light that the limits of depth keep from the picture: of the paths that reach one,
// one in kEvery is followed from there twice, by the same random numbers, with the limits as they
// are and with kFarther bounces more. The picture takes no part of this.
template <class Rays>
[[gnu::noinline]] void measureCut(const PathScene<Rays>& path, PathState& state, const Hit& hit,
                                  PixelSampler& sampler, std::vector<DirectionSample>& samples,
                                  RayCounts& counts) {
  constexpr uint32_t kEvery = 64;
  constexpr int kFarther = 256;
  constexpr uint64_t kPurpose = 0x637574;  // apart from other uses of the key
  state.isMeasured = true;
  if (hash(sampler.sampleKey(), kPurpose) % kEvery != 0) return;
  PathScene<Rays> limited = path;
  limited.measuresCut = false;
  PathScene<Rays> farther = limited;
  farther.maxDepth = std::min(path.maxDepth, INT_MAX - kFarther) + kFarther;
  farther.maxTransmissionDepth = std::min(path.maxTransmissionDepth, INT_MAX - kFarther) + kFarther;
  RayCounts uncounted;
  const auto follow = [&](const PathScene<Rays>& scene) {
    return luminance(followPath(scene, state, hit, sampler, samples, uncounted, nullptr));
  };
  const float cut = follow(farther) - follow(limited);
  sampler.startVertex(state.depth);
  if (std::isfinite(cut)) counts.depthCut.add(state.bounces() == path.maxDepth, kEvery * cut);
}

// To be called before each vertex.
template <class Rays>
void watchDepth(const PathScene<Rays>& path, PathState& state, const std::optional<Hit>& hit,
                PixelSampler& sampler, std::vector<DirectionSample>& samples, RayCounts& counts) {
  if (!path.measuresCut || !hit || state.isMeasured) return;
  if (state.bounces() == path.maxDepth || state.transmissions == path.maxTransmissionDepth)
    measureCut(path, state, *hit, sampler, samples, counts);
}

// What a path that stands before `hit` goes on to find.
template <class Rays>
Rgb followPath(const PathScene<Rays>& path, PathState state, std::optional<Hit> hit,
               PixelSampler& sampler, std::vector<DirectionSample>& samples, RayCounts& counts,
               FirstHit* first) {
  Rgb radiance(0);
  sampler.startVertex(state.depth);
  for (;;) {
    watchDepth(path, state, hit, sampler, samples, counts);
    if (!pathVertex(path, state, hit, sampler, samples, counts, first, radiance)) return radiance;
    sampler.startVertex(state.depth);
    hit = closestHit(path.rays, state.ray, sampler);
  }
}

// Radiance towards the camera along the ray of `start`, which meets `hit` first. `samples` is
// scratch memory; `first` may be null.
template <class Rays>
Rgb pathRadiance(const PathScene<Rays>& path, const PathState& start, const std::optional<Hit>& hit,
                 PixelSampler& sampler, std::vector<DirectionSample>& samples, RayCounts& counts,
                 FirstHit* first) {
  ++counts.camera;
  const Rgb radiance = followPath(path, start, hit, sampler, samples, counts, first);
  counts.depthCut.addFound(radiance);
  return radiance;
}

}  // namespace chromeball
