// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion: which part of the sky a surface sees (HDRI book, section 9.8.2).
#pragma once

#include <cmath>
#include <span>

#include "film/aov.h"
#include "math/vec.h"
#include "trace/ray.h"
#include "transport/integrator.h"

namespace chromeball {

struct PathContext;
struct Surface;
struct World;

// Which light of the probe geometry blocks.
struct Occlusion {
  bool ambient = false;       // diffuse
  bool reflection = false;    // specular and transmitted
  float distance = INFINITY;  // within which surfaces block diffuse light, metres
  bool uniformBent = false;   // bent normals are unweighted means (HDRI book, section 9.8.2)
};

// One direction of the hemisphere above a surface, and how much light passes there.
struct SkyRay {
  vec3 direction;
  Rgb transmittance;
};

// A sky ray with density cos / pi around `normal`; nothing passes below the geometry. A ray that is
// not blocked within `distance` metres sees the sky. Uses the random numbers of light samples.
SkyRay cosineSkyRay(const World& world, const Surface& surface, const vec3& normal, float distance,
                    RayMask visible, PathContext& context);

// Layers that need rays of their own at the first surface: ambient occlusion, bent normals (HDRI
// book, section 9.8.2) and irradiance (figure 9.38c).

// Another integrator, which also fills these layers of FirstHit, one ray or path each a sample.
// The layers change neither the picture, nor its estimate of the light beyond depth limits, nor
// what guides learn.
//   ambientOcclusion  an estimate of 1 / pi integral of V cos, V the visibility of the sky
//   unoccluded        of the vector integral of V cos (or of V) times the direction
//   irradiance        pi times the radiance of a white Lambertian surface in the place of the first
//                     one, the rest of the scene as it is
class SurfaceLayers : public Integrator {
 public:
  // All arguments must outlive this, except `tracer`, which traces the picture.
  SurfaceLayers(const Integrator& picture, const PathTracer& tracer, std::span<const Aov> wanted,
                const Occlusion& occlusion);

  size_t batch() const override { return picture_.batch(); }
  void sampleMany(const CameraSamples& cameras, PathContext& context,
                  std::span<Sample> samples) const override;
  std::vector<Accumulation> layers() const override { return picture_.layers(); }
  std::vector<std::string> groups() const override { return picture_.groups(); }
  RayMask visible() const override { return picture_.visible(); }

 private:
  // Returns the defect of the irradiance, if it has one; the sample is then excluded.
  std::optional<Defect> measure(const CameraSample& camera, PathContext& context) const;

  const Integrator& picture_;
  PathTracer tracer_;
  Occlusion occlusion_;
  bool wantsOcclusion_, wantsBent_, wantsIrradiance_;
};

}  // namespace chromeball
