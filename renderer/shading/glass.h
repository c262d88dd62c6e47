// SPDX-License-Identifier: Apache-2.0
// The boundary of a transmissive body (KHR_materials_volume): light is reflected or refracted.
#pragma once

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

// Relative refractive indices at a boundary (eta of fresnel.h), one per channel: they differ for a
// dispersive body. `front`: the index of the body's own medium against air, to which the
// reflectance of KHR_materials_specular refers.
struct RefractiveIndex {
  Rgb eta;
  float front;
};

// GGX microfacets that reflect by Fresnel's equations and refract the rest (Walter et al. 2007),
// both scaled by 1 / (their total albedo in one bounce) (Turquin 2019, "Practical multiple
// scattering compensation for microfacet models"). That conserves energy exactly for every viewing
// direction, but is reciprocal only for a smooth surface. KHR_materials_specular changes Fresnel's
// reflectance F below the critical angle to
//   F0 + (F90 - F0) (F - F(0)) / (1 - F(0)),   affine in F.
// Paths carry basic radiance, L / n^2, so there is no factor eta^2: it cancels between the eye and
// a light in the same medium.
class Glass {
 public:
  Glass(const MaterialPoint& material, const RefractiveIndex& index, const Surface& surface,
        const vec3& wo, const BsdfTables& tables, float mirrorAlpha);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return !smooth_ && lobes == lobes_; }
  const vec3& normal() const { return frame_.z; }
  float albedo() const;
  // Refracted light is looked up in the direction inside the body, for green.
  void addTo(MapLobes& lobes, float weight) const;
  void keepOnly(KeptLobes) {}  // glass has a limit of its own

 private:
  Rgb fresnel(float cosine) const;  // of each channel
  float fresnel(float cosine, int channel) const;
  BsdfValue reflect(const vec3& wi) const;
  // Refraction with the index of `channel`; the other channels use the same direction. The pdf is
  // sample()'s for refraction.
  BsdfValue refract(const vec3& wi, int channel) const;
  // Probability of sampling reflection at a facet.
  float reflectProbability(const Rgb& reflectance) const {
    return (reflectance.x + reflectance.y + reflectance.z) / 3;
  }

  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  Rgb eta_;
  bool dispersive_;
  Rgb tint_;
  Rgb offset_, slope_;  // reflectance below the critical angle: offset + slope F
  float alpha_;
  float lambdaO_;
  Rgb gain_;  // 1 / (albedo in one bounce)
  bool smooth_;
  Lobes lobes_;  // broad or narrow
};

// Transmission through a sheet without thickness (KHR_materials_transmission without a volume).

// The GGX reflection lobe of the sheet's roughness, mirrored to the far side and scaled to transmit
// `fraction` of the light (KHR_materials_transmission, "Specular BTDF"): the light is spread but
// not refracted. A smooth sheet transmits light straight.
class Sheet {
 public:
  // `fraction`: the transmitted fraction of all incident light, per channel.
  Sheet(const Rgb& fraction, float roughness, const Surface& surface, const vec3& wo,
        const BsdfTables& tables, float mirrorAlpha);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return !smooth_ && lobes == lobes_; }
  float albedo() const { return luminance(fraction_); }
  void addTo(MapLobes& lobes, float weight) const {
    lobes.add({weight * fraction_, -wo_, false, smooth_ ? 0 : std::sqrt(alpha_)});
  }
  void keepOnly(KeptLobes kept) {
    if (!(smooth_ ? kept.straight : kept.specular)) fraction_ = Rgb(0);
  }

 private:
  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_, localWo_;  // in the world and in the frame
  Rgb fraction_;
  float alpha_, lambdaO_;
  bool smooth_;
  Lobes lobes_;  // broad or narrow
  float gain_;   // 1 / (albedo of the white lobe in one bounce)
};

}  // namespace chromeball
