// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: direct light at one vertex of a path.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "lighting/strategy.h"
#include "scene/surface.h"
#include "transport/context.h"
#include "transport/guided_bsdf.h"
#include "transport/media.h"
#include "transport/path_settings.h"
#include "transport/place.h"
#include "transport/world.h"

namespace chromeball {

// The path vertex at which direct light is estimated.
struct Vertex {
  const LightPoint& point;
  const Surface& surface;
  const GuidedBsdf& bsdf;
  const Media& media;            // on the viewer's side
  const GuideRegion* region;     // of the guide; null: light samples are not guided here
  Rgb throughput{1};             // weight of its light at the camera, for light groups
  const Place* place = nullptr;  // of the path
};

// A copy of a vertex that waits for its sample of LightSource::sampleAt().
struct WaitingVertex {
  explicit WaitingVertex(const Vertex& vertex)
      : point(vertex.point),
        surface(vertex.surface),
        bsdf(vertex.bsdf.bsdf()),
        guided(vertex.bsdf, bsdf, point.position),
        region(vertex.region),
        throughput(vertex.throughput) {
    point.bsdf = &bsdf;
  }
  WaitingVertex(const WaitingVertex&) = delete;

  LightPoint point;
  Surface surface;
  Bsdf bsdf;
  GuidedBsdf guided;
  const GuideRegion* region;
  Rgb throughput;
};

// Light from the probe at a vertex, for paths that are traced together (integrator.h).
struct DeferredLight {
  bool isDrawn = false;      // input: `sample` is the strategy's, with a pdf of 0 for none
  bool waits = false;        // input: `sample` is drawn with those of other paths, see `waiting`
  DirectionSample sample{};  // output: the one taken
  std::unique_ptr<WaitingVertex> waiting;  // output: for completeWaiting()
  bool hasShadowRay = false;
  Ray shadowRay{};       // output
  Rgb radiance{0};       // at the camera if nothing blocks the shadow ray
  LightRecord record{};  // likewise; only if the context wants records
  Rgb scattered{0};      // `radiance` per irradiance of `sample`

  // Set if the guide chose the direction; complete() then calculates the radiance.
  const GuideRegion* region = nullptr;
  float treePdf = 0;
  LightPoint point{};  // the vertex
  BsdfValue bsdf{};
  Rgb throughput{0};
};

// Radiance scattered towards the viewer, estimated by light samples with their MIS weights against
// BSDF samples.
class DirectLight {
 public:
  // `world` and `lighting` must outlive this.
  DirectLight(const World& world, const LightSource& lighting, const PathSettings& settings)
      : world_(world),
        lighting_(lighting),
        settings_(settings),
        takesOneSample_(lighting.takesOneSample()) {}

  // Light from the probe, by the strategy's samples; broad lobes only.
  Rgb probe(const Vertex& vertex, PathContext& context) const;
  // The same, up to the shadow ray, for a strategy that takes one sample.
  void defer(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
             PathContext& context) const;
  // The second part of defer() where the vertex waits, when its sample has been drawn.
  void completeWaiting(DeferredLight& light, PathContext& context) const;
  // The second part of defer() where light.region is set. `found`: what
  // LightSource::escaped() returns for light.point and the direction of the shadow ray.
  void complete(const LightSource::Escaped& found, DeferredLight& light,
                const PathContext& context) const;
  // Adds what of it passes the shadow ray to the path's groups.
  void addToGroups(const DeferredLight& light, const Rgb& passed, PathContext& context) const;
  // Light from one of World::sources, which lights narrow lobes too.
  Rgb ofScene(size_t source, const Vertex& vertex, PathContext& context) const;
  // The transmittance up to the light at the end of a shadow ray whose `passed` the acceleration
  // structure found: others may share the light's place. `key`: PixelSampler::sampleKey().
  Rgb throughEnd(const Rgb& passed, const Ray& ray, const Media& media, RayMask mask, uint32_t key,
                 const LightEnd& end) const;

 private:
  // A light sample, and the strategy's pdf of its direction.
  struct LightSample {
    DirectionSample direction;
    float strategyPdf;
  };
  // Whether a sample of the guide takes the place of the strategy's, except its delta samples.
  static bool guideChooses(const Vertex& vertex, const PathContext& context);
  // defer() for a sample of the guide, and for the strategy's.
  void deferGuided(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
                   PathContext& context) const;
  void deferDrawn(const Vertex& vertex, const Rgb& throughput, DeferredLight& light,
                  PathContext& context) const;
  // The strategy's sample, or one of the guide, with the pdf of the mixture.
  static LightSample ofStrategy(const Vertex& vertex, const DirectionSample& own);
  static LightSample ofGuide(const GuideRegion& region, const DirectionTree::Sample& sample,
                             const LightSource::Escaped& found);
  // The one sample of a strategy that takes no more; its pdf is 0 if there is none.
  DirectionSample sampleOfStrategy(const LightPoint& point, PathContext& context) const;
  Rgb weighted(const DirectionSample& light, const BsdfValue& bsdf) const;
  void addToGroups(std::optional<size_t> source, const LightPoint& point,
                   const DirectionSample& light, const Rgb& weight, PathContext& context) const;
  static LightRecord record(const LightPoint& point, const LightSample& light,
                            const BsdfValue& bsdf);

  // Transmittance of a shadow ray from the vertex: occluders, and absorption in media. `end`: where
  // the ray ends, if in the scene.
  Rgb transmittance(const Vertex& vertex, const Ray& ray, PathContext& context,
                    const LightEnd& end = {}) const;
  Rgb visibility(const Ray& ray, const Media& media, PathContext& context,
                 const LightEnd& end) const;
  Rgb visibility(const Ray& ray, const Media& media, RayMask mask, uint32_t key,
                 const LightEnd& end) const;
  // Transmittance of the other surfaces at the vertex's place in a direction, and the media behind
  // them.
  Rgb crossPlace(Place place, const vec3& direction, float time, Media& media) const;
  // False for an instance that is not in this part of the scene.
  bool exists(const LightEnd& end, RayMask mask) const {
    return end.instance == LightEnd::kNone || world_.accel.mask(end.instance) & mask;
  }

  const World& world_;
  const LightSource& lighting_;
  PathSettings settings_;
  bool takesOneSample_;
};

}  // namespace chromeball
