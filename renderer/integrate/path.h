// SPDX-License-Identifier: Apache-2.0
// Path tracing with next-event estimation and multiple importance sampling.
#pragma once

#include <optional>

#include "integrate/context.h"
#include "integrate/direct_light.h"
#include "integrate/media.h"
#include "integrate/path_settings.h"
#include "integrate/world.h"
#include "scene/camera.h"

namespace chromeball {

// A path between two vertices, or before its first.
struct PathState {
  Ray ray;
  Rgb radiance{0};    // found so far
  Rgb throughput{1};  // of what is found next
  LightPoint from{};  // where the ray starts; unused for camera rays
  // No light sample competes with the ray: it comes from the camera or a delta lobe.
  bool isDelta = true;
  float pdf = 0;  // of the ray's direction at `from`, over solid angle; unless isDelta
  Lobes lobes = Lobes::Narrow;  // that the ray was sampled from; the camera counts as a mirror
  int depth = 0;                // of the next vertex
  int straight = 0;       // vertices passed without a change of direction; they are no bounces
  int transmissions = 0;  // bounces in and on solid glass, limited by maxTransmissionDepth
  bool cutIsEstimated = false;  // estimateDepthCut() has seen the path
  Media media;                  // that the ray is in
  float length = 0;             // metres from the camera
  Beam beam{};                  // around the camera's ray, where textures are filtered
  FirstHit* first = nullptr;    // filled at the first surface seen; null: not wanted

  // Bounces that maxDepth limits.
  int bounces() const { return depth - straight - transmissions; }
};

// Estimates radiance along paths. Immutable and shared by all threads; what changes is in PathState
// and PathContext. `Hit` arguments are what the state's ray meets first, nullopt for nothing.
class PathTracer {
 public:
  // `world` and `lighting` must outlive this.
  PathTracer(const World& world, const LightingStrategy& lighting, const PathSettings& settings);

  // Radiance towards the camera along the ray of `start`.
  Rgb radiance(const PathState& start, const std::optional<Hit>& hit, PathContext& context) const;

  // The state's radiance plus what the rest of the path finds.
  Rgb follow(PathState state, std::optional<Hit> hit, PathContext& context) const;

  // One vertex: adds what is found there to the state's radiance and moves on to the next ray.
  // Returns false where the path ends. estimateDepthCut() is to be called before it.
  bool vertex(PathState& state, const std::optional<Hit>& hit, PathContext& context) const;

  // The part of vertex() after emission, with the BSDF given: direct light, and the next direction.
  bool scatter(PathState& state, const Surface& surface, const Bsdf& bsdf,
               PathContext& context) const;

  // What the emission of `surface` adds to the state's radiance.
  Rgb foundEmission(const PathState& state, const Surface& surface, const Instance& instance) const;

  // Where the path is about to reach a limit of depth, adds an estimate of the light beyond it to
  // the context, for a fraction of the paths. The state's radiance does not change.
  void estimateDepthCut(PathState& state, const std::optional<Hit>& hit,
                        PathContext& context) const;

  std::optional<Hit> closestHit(const Ray& ray, PathContext& context) const;

  // Moves a camera path past back faces that the camera does not see (--single-sided), to just
  // before the first surface that it does see; returns that hit.
  std::optional<Hit> skipHiddenBacks(PathState& state, std::optional<Hit> hit,
                                     PathContext& context) const;
  bool isHiddenBack(const PathState& state, const Hit& hit) const;

  const World& world() const { return world_; }
  const PathSettings& settings() const { return settings_; }
  float mirrorAlpha() const { return mirrorAlpha_; }

 private:
  Rgb escapedRadiance(const PathState& state) const;  // where the ray meets nothing
  bool scatterLayered(PathState& state, const Instance& instance, const Surface& surface,
                      const MaterialPoint& material, PathContext& context) const;
  template <bool kLayered>
  bool scatterAs(PathState& state, const Surface& surface, const Bsdf& bsdf,
                 PathContext& context) const;
  void followTwice(PathState& state, const Hit& hit, PathContext& context) const;

  const World& world_;
  const LightingStrategy& lighting_;
  PathSettings settings_;
  float mirrorAlpha_;
  DirectLight direct_;
};

// Russian roulette: ends a path at random in proportion to its throughput; survivors are weighted
// up by as much, so that the estimate stays unbiased. The first two bounces always continue.
inline bool survivesRoulette(Rgb& throughput, int depth, const PixelSampler& sampler) {
  if (depth < 2) return true;
  const float survival = std::min(maxComponent(throughput), 1.0f);
  if (sampler.get1(dimension::kRoulette) >= survival) return false;  // NaN goes on, to be counted
  throughput /= survival;
  return true;
}

}  // namespace chromeball
