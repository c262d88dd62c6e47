// SPDX-License-Identifier: Apache-2.0
// Path tracing with next-event estimation and multiple importance sampling.
#pragma once

#include <optional>

#include "scene/camera.h"
#include "transport/context.h"
#include "transport/direct_light.h"
#include "transport/media.h"
#include "transport/path_settings.h"
#include "transport/place.h"
#include "transport/seen_feature.h"
#include "transport/world.h"

namespace chromeball {

// The state of a path before its next vertex.
struct PathState {
  Ray ray;
  Rgb radiance{0};                      // accumulated so far
  Rgb throughput{1};                    // weight of the radiance found at the next vertex
  LightPoint from{};                    // origin of the ray; unused for camera rays
  const GuideRegion* region = nullptr;  // of the guide, at `from`; null: not guided there
  Rgb throughputBefore{1};              // the bounce at `from`
  // The ray comes from the camera or a delta lobe: light sampling could not find its direction.
  bool isDelta = true;
  float pdf = 0;                  // of the ray's direction at `from`, over solid angle; if !isDelta
  Lobes lobes = Lobes::Narrow;    // the lobes that were sampled; camera rays count as a mirror's
  int depth = 0;                  // of the next vertex
  int straight = 0;               // vertices passed without a change of direction; not bounces
  int transmissions = 0;          // bounces in and on solid glass, limited by maxTransmissionDepth
  int diffuse = 0, specular = 0;  // bounces by kind (PathSettings::maxDiffuseDepth)
  bool cutIsEstimated = false;    // estimateDepthCut() has processed this path
  // pdf / BSDF pdf of the guided bounces so far. A path towards a caustic has little throughput in
  // proportion to its light; roulette treats it as if the BSDF had found it.
  float guideRatio = 1;
  GuidedBounce guided;                // the first one
  bool scattered = false;             // by a lobe that is not delta: shadow rays are possible
  float widening = 0;                 // regularizationWidth() of the sample; 0: no regularisation
  float minAlpha = 0;                 // of the next vertices (path_settings.h)
  Media media;                        // the medium of the ray
  Place place;                        // at the origin of the ray, whose surfaces are still to cross
  float length = 0;                   // of the path from the camera, metres
  Beam beam{};                        // footprint of the camera ray, for texture filtering
  DeferredLight* deferred = nullptr;  // null: trace shadow rays at once
  FirstHit* first = nullptr;  // output, written at the first visible surface; null: not wanted

  // The number of bounces that maxDepth limits.
  int bounces() const { return depth - straight - transmissions; }

  // Continues behind or before a surface, in direction `wi`.
  void leave(const Surface& surface, const vec3& wi);
};

// Estimates radiance along paths. Immutable and shared by all threads; mutable state is in
// PathState and PathContext. `Hit` arguments are the closest hit of the state's ray, nullopt if it
// escapes.
class PathTracer {
 public:
  // `world` and `lighting` must outlive this.
  PathTracer(const World& world, const LightSource& lighting, const PathSettings& settings);
  // Of the same light in the same world, but with other settings.
  PathTracer(const PathTracer& other, const PathSettings& settings);

  // Radiance towards the camera along the ray of `start`.
  Rgb radiance(const PathState& start, const std::optional<Hit>& hit, PathContext& context) const;

  // state.radiance plus the radiance found along the rest of the path.
  Rgb follow(PathState state, std::optional<Hit> hit, PathContext& context) const;

  // Processes one vertex: adds its emission and direct light to state.radiance and samples the next
  // ray. Returns false where the path ends. Call estimateDepthCut() first.
  bool vertex(PathState& state, const std::optional<Hit>& hit, PathContext& context) const;

  // Radiance that `surface`, where the ray of a camera path ends, reflects with a given BSDF; 0 at
  // the limit of depth, except what glass transmits.
  Rgb reflected(PathState state, const Surface& surface, const Bsdf& bsdf,
                PathContext& context) const;

  // The part of vertex() after emission, for a given BSDF: direct light and the next direction,
  // within the limits of depth.
  bool scatter(PathState& state, const Surface& surface, const Bsdf& bsdf,
               PathContext& context) const;

  // The MIS-weighted contribution of the emission of `surface` to state.radiance.
  Rgb foundEmission(const PathState& state, const Surface& surface, const Hit& hit) const;
  // The same for throughput 1. `pdf`: of the ray's direction at `from`; 0: light samples could not
  // find it.
  Rgb foundEmission(const LightPoint& from, float pdf, const vec3& direction,
                    const Surface& surface, const Hit& hit) const;

  // At a depth limit, for a fraction of the paths: adds an estimate of the light beyond the limit
  // to context.depthCut. state.radiance does not change.
  void estimateDepthCut(PathState& state, const std::optional<Hit>& hit,
                        PathContext& context) const;

  std::optional<Hit> closestHit(const Ray& ray, PathContext& context) const;
  // The hit of the next surface that the path meets.
  std::optional<Hit> nextHit(const PathState& state, PathContext& context) const;

  // Whether it only matters of the state's ray whether it escapes: no bounce is left, and no
  // surface of the scene shows then or lets the path pass. A shadow ray, which costs less, finds
  // that.
  bool endsAtAnyHit(const PathState& state, const PathContext& context) const;
  bool escapes(const Ray& ray, PathContext& context) const;

  // The surface that the path meets where it has hit one: another one if that coincides with it and
  // comes first. nullopt if the path ignores the surface and no other one coincides with it.
  std::optional<Hit> metAt(PathState& state, const Hit& hit, PathContext& context) const;
  // The same, but a choice at random does not change the throughput: its weight is left in
  // `weight`.
  std::optional<Hit> metAt(PathState& state, const Hit& hit, float& weight,
                           PathContext& context) const;

  // Moves a camera path past back faces that the camera does not see (--single-sided); returns the
  // hit of the first visible surface.
  std::optional<Hit> skipHiddenBacks(PathState& state, std::optional<Hit> hit,
                                     PathContext& context) const;

  // Adds the light that a ray finds if it hits nothing. `escaped`: the probe's radiance and pdf;
  // `background`: what narrow lobes and the camera see.
  void addEscaped(PathState& state, const LightSource::Escaped& escaped,
                  PathContext& context) const;
  void addBackground(PathState& state, const Rgb& background, PathContext& context) const;

  const World& world() const { return world_; }
  const LightSource& lighting() const { return lighting_; }
  const DirectLight& direct() const { return direct_; }
  const PathSettings& settings() const { return settings_; }
  float mirrorAlpha() const { return mirrorAlpha_; }
  // Whether paths without bounces left end, without light, at each surface of the scene.
  bool surfacesEndPaths() const { return surfacesEndPaths_; }
  // Whether a path with this key (PixelSampler::sampleKey()) is one of those that
  // estimateDepthCut() follows beyond the limit.
  static bool isFollowed(DepthLimit limit, uint32_t key);

 private:
  // `weight`: output, the weight of the path that continues, if that is chosen at random.
  std::optional<Hit> metAt(PathState& state, const Hit& hit, const Surface& surface, float& weight,
                           PathContext& context) const;
  static bool surfacesEndPaths(const World& world);
  bool sharesPlace(const Hit& hit) const {
    return world_.sharedPlaces.contains(hit.instance, hit.triangle);
  }
  Surface surfaceOf(const PathState& state, const Hit& hit) const;
  Rgb weighted(const PathState& state, const LightSource::Escaped& escaped,
               PathContext& context) const;
  Rgb distantRadiance(const PathState& state, PathContext& context) const;
  bool scatterLayered(PathState& state, const Instance& instance, const Surface& surface,
                      const MaterialPoint& material, PathContext& context) const;
  ExtendedPoint extendedPointAt(const PathState& state, const Instance& instance,
                                const Surface& surface) const;
  template <bool kLayered>
  bool scatterAs(PathState& state, const Surface& surface, const Bsdf& bsdf,
                 PathContext& context) const;
  // Removes the lobes whose depth limit the path has reached. Returns false if all are.
  bool limitKinds(const PathState& state, Bsdf& bsdf) const;
  // The guide of the bounces from here; null: none.
  const CausticGuide* guideOf(const PathState& state) const;
  static void noteGuided(PathState& state, const GuidedBsdf::Bounce& bounce,
                         const PathContext& context);
  std::optional<DepthLimit> reachedLimit(const PathState& state, const Hit& hit) const;
  void followTwice(PathState& state, const Hit& hit, DepthLimit limit, PathContext& context) const;

  const World& world_;
  const LightSource& lighting_;
  PathSettings settings_;
  float mirrorAlpha_;
  bool limitsKinds_, surfacesEndPaths_;
  SeenFeature seen_;
  DirectLight direct_;
};

// Russian roulette with survival probability min(largest throughput channel x guideRatio, 1);
// survivors are divided by it, so that the estimate stays unbiased. The first two bounces always
// survive.
inline constexpr int kFirstRoulette = 2;  // the depth
inline bool survivesRoulette(Rgb& throughput, float guideRatio, int depth,
                             const PixelSampler& sampler) {
  if (depth < kFirstRoulette) return true;
  const float survival = std::min(maxComponent(throughput) * guideRatio, 1.0f);
  if (sampler.get1(dimension::kRoulette) >= survival) return false;  // NaN survives, to be counted
  throughput /= survival;
  return true;
}

}  // namespace chromeball
