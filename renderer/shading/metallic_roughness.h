// SPDX-License-Identifier: Apache-2.0
// glTF metallic-roughness (glTF 2.0, appendix B), for materials with a specular lobe.
#pragma once

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

// A diffuse base under a specular surface, at one point, for one viewing direction:
//   f = specular + diffuse (1 - S(wo))(1 - S(wi)) / (pi (1 - S_mean))
//     + multiple (1 - E(wo))(1 - E(wi)) / (pi (1 - E_mean)).
// Specular: one bounce off GGX microfacets under Schlick's Fresnel term; E is its albedo for
// F0 = F90 = 1. Multiple: the light that microfacets scatter more than once (Kulla and Conty 2017,
// "Revisiting Physically Based Shading at Imageworks"). S is the albedo of the dielectric surface,
// including both terms: light is attenuated by 1 - S on the way into and out of the base (Kelemen
// and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model with Importance
// Sampling"). Reciprocal; a white material reflects all light.
class MetallicRoughness {
 public:
  // `wo`: unit, towards the viewer; the surface's normals are on its side. The specular lobe is
  // narrow if its alpha (roughness squared) is below `mirrorAlpha`. The tables must outlive this.
  MetallicRoughness(const MaterialPoint& material, const Surface& surface, const vec3& wo,
                    const BsdfTables& tables, float mirrorAlpha = 0)
      : MetallicRoughness(material, material.baseColor * (1 - material.metallic),
                          material.baseColor, surface, wo, tables, mirrorAlpha) {}

  // Takes the diffuse albedo and the metal's F0 instead of the base colour.
  MetallicRoughness(const MaterialPoint& material, const Rgb& diffuse, const Rgb& metalF0,
                    const Surface& surface, const vec3& wo, const BsdfTables& tables,
                    float mirrorAlpha);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return lobes == Lobes::Broad ? hasBroad_ : hasNarrow_; }
  bool transmits() const { return false; }
  const vec3& normal() const { return frame_.z; }

  // Luminance reflected towards wo under uniform white radiance of 1.
  float albedo() const { return albedo_; }
  // S(wo): the fraction of light that does not reach the layer beneath.
  float surfaceAlbedo() const { return surfaceAlbedo_; }

  void addTo(MapLobes& lobes, float weight) const;
  // The light that microfacets scatter more than once counts as diffuse.
  void keepOnly(KeptLobes kept);

 private:
  // The dielectric surface of a material, with the largest component of its F0:
  //   S(mu) = F0 a + F90 b + multiple (1 - a - b).
  struct DielectricSurface {
    float f0, f90, multiple;
    float albedo(const SpecularAlbedo& s) const {
      return f0 * s.a + f90 * s.b + multiple * (1 - s.a - s.b);
    }
  };

  BsdfValue evaluateLocal(const vec3& wi, Lobes lobes) const;  // wi in the frame

  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  float alpha_;
  bool smooth_;  // the specular lobe is a delta
  bool narrow_;  // the specular lobe is a delta or narrower than the limit
  bool hasBroad_, hasNarrow_;
  Rgb f0_, f90_;
  EnergyTable::Row energy_;
  DielectricSurface dielectric_;
  Rgb diffuse_;                // albedo of the base, times (1 - S(wo)) / (1 - S_mean)
  Rgb multiple_;               // times (1 - E(wo)) / (1 - E_mean)
  float specularProbability_;  // of sampling the specular lobe
  float albedo_, surfaceAlbedo_;
};

}  // namespace chromeball
