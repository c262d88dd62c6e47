// SPDX-License-Identifier: Apache-2.0
// Metallic-roughness with grooves (KHR_materials_anisotropy).
#pragma once

#include "math/frame.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {

// Anisotropic GGX over a diffuse base. What microfacets scatter again is put back into the same
// lobe (Turquin 2019), and the base gets what the surface does not reflect towards the viewer: no
// light is lost, but the diffuse part is not reciprocal.
class Brushed {
 public:
  // `tangent`: unit, along the grooves' wider highlight; diffuse albedo and metal's F0 as in Bsdf.
  Brushed(const MaterialPoint& material, const Rgb& diffuse, const Rgb& metalF0, float strength,
          const vec3& tangent, const Surface& surface, const vec3& wo, float mirrorAlpha);

  Bsdf::Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const {
    return lobes == Lobes::Narrow ? narrow_ : !narrow_ || specularFraction_ < 1;
  }
  const vec3& normal() const { return frame_.z; }
  float albedo() const { return albedo_; }
  float surfaceAlbedo() const { return surfaceAlbedo_; }

 private:
  Rgb fresnel(float cosine) const;

  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  vec2 alpha_;
  float lambdaO_;
  bool narrow_;
  Rgb f0_, f90_;
  Rgb gain_;     // on the specular lobe, for what it scatters again
  Rgb diffuse_;  // times what passes the surface
  float specularFraction_, albedo_, surfaceAlbedo_;
};

}  // namespace chromeball
