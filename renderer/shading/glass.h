// SPDX-License-Identifier: Apache-2.0
// The boundary of a transmissive body: what is not reflected is refracted.
#pragma once

#include "math/frame.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {

// Indices of refraction at a boundary, as ratios (dielectric.h): one for each channel, which differ
// where the body disperses light. `front`: of the body's own medium against air, which is what the
// reflectance of KHR_materials_specular refers to.
struct RefractiveIndex {
  Rgb eta;
  float front;
};

// GGX microfacets that reflect by Fresnel's equations and refract the rest (Walter et al. 2007),
// both raised by 1 / (their albedo in one bounce), so that nothing is lost (Turquin 2019). That is
// exact for every view and reciprocal only where the surface is smooth. KHR_materials_specular
// scales Fresnel's reflectance F before the critical angle, which keeps it affine in F:
//   F0 + (F90 - F0) (F - F(0)) / (1 - F(0)). Carries basic radiance,
// L / n^2, and so has no factor eta^2: it cancels between the eye and a light in the same medium.
class Glass {
 public:
  Glass(const MaterialPoint& material, const RefractiveIndex& index, const Surface& surface,
        const vec3& wo, float mirrorAlpha);

  Bsdf::Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return !smooth_ && lobes == lobes_; }
  const vec3& normal() const { return frame_.z; }
  float albedo() const;

 private:
  Rgb fresnel(float cosine) const;  // by channel
  float fresnel(float cosine, int channel) const;
  Bsdf::Value reflect(const vec3& wi) const;
  // One channel's refraction, as if the others took the same way; the pdf counts those facets
  // that sample() lets through.
  Bsdf::Value refract(const vec3& wi, int channel) const;
  // Of sampling reflection, at a facet.
  float reflectFraction(const Rgb& reflectance) const {
    return (reflectance.x + reflectance.y + reflectance.z) / 3;
  }

  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  Rgb eta_;
  bool dispersive_;
  Rgb tint_;
  Rgb offset_, slope_;  // reflectance, where it is not total: offset + slope F
  float alpha_;
  float lambdaO_;
  Rgb gain_;  // 1 / albedo in one bounce
  bool smooth_;
  Lobes lobes_;  // what it is
};

}  // namespace chromeball
