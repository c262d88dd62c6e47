// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: direct light at one vertex of a path.
#pragma once

#include <cstdint>
#include <optional>

#include "integrate/context.h"
#include "integrate/media.h"
#include "integrate/path_settings.h"
#include "integrate/world.h"
#include "lighting/strategy.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {

// The path vertex at which direct light is estimated.
struct Vertex {
  const LightPoint& point;
  const Surface& surface;
  const Bsdf& bsdf;
  const Media& media;  // on the viewer's side
};

// Light from the probe at a vertex, for paths that are traced together (path_batch.h).
struct DeferredLight {
  DirectionSample sample{};  // input: the light sample; pdf 0: none
  bool hasShadowRay = false;
  Ray shadowRay{};  // output
  Rgb radiance{0};  // at the camera if nothing blocks the shadow ray
};

// Radiance scattered towards the viewer, estimated by light samples with their MIS weights against
// BSDF samples.
class DirectLight {
 public:
  // `world` and `lighting` must outlive this.
  DirectLight(const World& world, const LightingStrategy& lighting, const PathSettings& settings)
      : world_(world), lighting_(lighting), settings_(settings) {}

  // From the probe, with the strategy's samples; broad lobes only.
  Rgb probe(const Vertex& vertex, PathContext& context) const;
  // The first half of the same: the shadow ray of a given sample, and `throughput` times what it
  // adds if nothing blocks it.
  void defer(const Vertex& vertex, const Rgb& throughput, DeferredLight& light) const;
  // From one point on an emissive triangle. World::emitters must not be null.
  Rgb emitter(const Vertex& vertex, PathContext& context) const;
  // From point, spot and directional lights. World::punctual must not be null.
  Rgb punctual(const Vertex& vertex, PathContext& context) const;

 private:
  // Transmittance of a shadow ray from the vertex: occluders, and absorption in the medium. `lamp`:
  // the instance at which the ray ends.
  Rgb transmittance(const Vertex& vertex, const Ray& ray, PathContext& context,
                    std::optional<uint32_t> lamp = {}) const;
  Rgb visibility(const Ray& ray, PathContext& context, std::optional<uint32_t> lamp) const;
  Rgb visibility(const Ray& ray, RayMask mask, std::optional<uint32_t> lamp) const;

  const World& world_;
  const LightingStrategy& lighting_;
  PathSettings settings_;
};

}  // namespace chromeball
