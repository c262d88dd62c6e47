// SPDX-License-Identifier: Apache-2.0
// Estimates the light at a point of a surface.
#pragma once

#include "bake/bake_points.h"
#include "transport/path.h"

namespace chromeball {

enum class BakedLight {
  Irradiance,        // of the front, W/m^2: pi times the radiance of a white Lambertian surface
  AmbientOcclusion,  // 1 / pi integral of V cos, V the visibility of the sky
  Radiance           // that the front emits and reflects along its normal
};
inline constexpr const char* kBakedLightNames[] = {"irradiance", "ambient-occlusion", "radiance"};

class PointLight {
 public:
  // The tracer must outlive this. `distance`: what is farther away does not occlude, metres.
  PointLight(const PathTracer& tracer, BakedLight what, float distance)
      : tracer_(tracer), what_(what), distance_(distance) {}

  BakedLight what() const { return what_; }
  const Scene& scene() const { return tracer_.world().scene; }

  // The front of the surface; with the interpolated normal, for radiance with that of the material.
  Surface surfaceAt(const BakePoint& point) const;

  // One sample; uses the random numbers of a path.
  Rgb sample(const BakePoint& point, const Surface& surface, PathContext& context) const;

  // Whether the point is inside a body: most rays from it first hit the back of a closed surface,
  // or that of any surface nearer than a texel. Glass and blended surfaces are not counted. Uses
  // samples of the current pixel.
  bool isBuried(const BakePoint& point, const Surface& surface,
                const std::vector<PlacedMesh>& meshes, PathContext& context) const;

 private:
  Rgb irradiance(const Surface& surface, PathContext& context) const;

  const PathTracer& tracer_;
  BakedLight what_;
  float distance_;
};

}  // namespace chromeball
