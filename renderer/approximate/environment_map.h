// SPDX-License-Identifier: Apache-2.0
// Environment mapping and ambient occlusion: approximations without paths (HDRI book, sections
// 9.8.1 and 9.8.2).
#pragma once

#include <memory>
#include <optional>

#include "approximate/occlusion.h"
#include "lighting/light_source.h"
#include "probe/prefiltered_probe.h"
#include "scene/scene.h"
#include "transport/integrator.h"

namespace chromeball {

// A probe as the approximate integrators use it.

// Prefiltered maps for the roughnesses that occur in a scene. With `splitsSuns` the maps are of the
// probe without its suns, which are light sources of their own (HDRI book, section 9.8.2), with
// the diameter `sunAngle` in degrees if it is given, as in lighting/suns.h.
class EnvironmentLight {
 public:
  EnvironmentLight(const Probe& probe, const Scene& scene, bool splitsSuns,
                   std::optional<double> sunAngle = {});

  EnvironmentLight(const EnvironmentLight&) = delete;

  const PrefilteredProbe& maps() const { return maps_; }
  const LightSource* suns() const { return suns_.get(); }  // null: there are none

 private:
  struct Parts;
  EnvironmentLight(Parts parts, const Scene& scene);

  std::unique_ptr<const LightSource> suns_;
  Probe sharp_;
  PrefilteredProbe maps_;  // refers to sharp_
};

// At the first surface: emission; the light of lamps, emitting surfaces and suns, by light samples
// with shadows, except that smooth lobes look suns up like the probe, as all lobes do with ambient
// light; and the probe's light, lobe by lobe (shading/bsdf_sample.h),
//   diffuse   albedo / pi E(n)
//   specular  albedo L'(R, roughness), R the mirror direction, or L in a direction that GGX
//             microfacets reflect if the lobe is narrow (PrefilteredProbe::kLeastRoughness); of
//             glass and sheets also what they transmit, looked up straight behind the boundary.
// Light that other surfaces reflect is missing. Without occlusion geometry blocks nothing, so that
// only convex objects are right; then a ray is traced from the camera alone, unless there are
// lamps. With ambient occlusion, a cosine-distributed ray decides on the diffuse light; with
// reflection occlusion, one that GGX microfacets reflect on the light of each specular lobe.
// Transmitted light is never blocked.
class EnvironmentMapIntegrator : public SingleIntegrator {
 public:
  // All arguments must outlive this. `lighting`: gives what the camera sees behind the scene.
  EnvironmentMapIntegrator(const World& world, const LightSource& lighting,
                           const EnvironmentLight& environment, const PathSettings& settings,
                           const Occlusion& occlusion);

  Sample sample(const CameraSample& camera, PathContext& context) const override;

 private:
  struct Point;
  Rgb ofSources(const Point& point, PathContext& context) const;
  Rgb ofProbe(const Point& point, PathContext& context) const;
  Rgb unsampled(const Point& point, const MapLobe& lobe) const;
  Rgb diffuse(const Point& point, const MapLobe& lobe, PathContext& context) const;
  Rgb specular(const Point& point, const MapLobe& lobe, PathContext& context) const;

  const EnvironmentLight& environment_;
  Occlusion occlusion_;
  PathTracer tracer_;
  DirectLight direct_;                     // of the scene's sources
  std::optional<DirectLight> directSuns_;  // of the probe's
};

}  // namespace chromeball
