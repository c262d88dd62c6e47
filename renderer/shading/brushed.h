// SPDX-License-Identifier: Apache-2.0
// Metallic-roughness with grooves (KHR_materials_anisotropy).
#pragma once

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

// One bounce off anisotropic GGX microfacets over a diffuse base. The specular lobe is multiplied
// by 1 + F0 (1 - E) / E, with E the white albedo of one bounce, to account for light that
// microfacets scatter more than once (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models"). The diffuse base is scaled by 1 - (albedo of the surface for wo): energy is
// conserved, but the diffuse part is not reciprocal.
class Brushed {
 public:
  // `tangent`: unit, the direction in which the highlight is wider; `strength` in [0, 1]; the rest
  // as for MetallicRoughness.
  Brushed(const MaterialPoint& material, const Rgb& diffuse, const Rgb& metalF0, float strength,
          const vec3& tangent, const Surface& surface, const vec3& wo, const BsdfTables& tables,
          float mirrorAlpha);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const {
    return lobes == Lobes::Narrow ? narrow_ : !narrow_ || specularProbability_ < 1;
  }
  const vec3& normal() const { return frame_.z; }
  float albedo() const { return albedo_; }
  float surfaceAlbedo() const { return surfaceAlbedo_; }
  void addTo(MapLobes& lobes, float weight) const;  // as if isotropic, of the mean alpha
  void keepOnly(KeptLobes kept);

 private:
  Rgb fresnel(float cosine) const;

  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  vec2 alpha_;
  float lambdaO_;
  bool narrow_;
  Rgb f0_, f90_;  // of the specular lobe, times its gain for multiple scattering
  Rgb diffuse_;   // times the fraction that passes the surface
  Rgb specularAlbedo_;
  float specularProbability_;  // of sampling the specular lobe
  float albedo_, surfaceAlbedo_;
};

}  // namespace chromeball
