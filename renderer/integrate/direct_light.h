// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: the light that reaches one vertex of a path straight from its sources.
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

// The vertex that light is estimated at.
struct Vertex {
  const LightPoint& point;
  const Surface& surface;
  const Bsdf& bsdf;
  const Media& media;  // on the viewer's side
};

// Reflected radiance towards the viewer of light samples, weighted against BSDF samples by MIS.
class DirectLight {
 public:
  // `world` and `lighting` must outlive this.
  DirectLight(const World& world, const LightingStrategy& lighting, const PathSettings& settings)
      : world_(world), lighting_(lighting), settings_(settings) {}

  // From the probe, by the strategy's samples; for broad lobes only.
  Rgb probe(const Vertex& vertex, PathContext& context) const;
  // From one point on an emissive triangle. World::emitters must not be null.
  Rgb emitter(const Vertex& vertex, PathContext& context) const;
  // From the lamps without extent. World::punctual must not be null.
  Rgb punctual(const Vertex& vertex, PathContext& context) const;

 private:
  // Fraction of light that passes a shadow ray from the vertex: surfaces between, and absorption
  // in the medium. `lamp`: the instance that the ray ends at.
  Rgb transmittance(const Vertex& vertex, const Ray& ray, PathContext& context,
                    std::optional<uint32_t> lamp = {}) const;
  Rgb visibility(const Ray& ray, PathContext& context, std::optional<uint32_t> lamp) const;
  Rgb visibility(const Ray& ray, RayMask mask, std::optional<uint32_t> lamp) const;

  const World& world_;
  const LightingStrategy& lighting_;
  PathSettings settings_;
};

}  // namespace chromeball
