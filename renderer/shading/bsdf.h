// SPDX-License-Identifier: Apache-2.0
// How a surface scatters light: eval, sample and pdf over the lobes its material really has.
#pragma once

#include "math/frame.h"
#include "scene/surface.h"
#include "shading/energy_table.h"

namespace chromeball {

// Makes the tables that the scene's materials will ask for, while no path is waiting for them.
void prepareBsdfs(const Scene& scene);

// Lights in the probe's place would show one by one in narrow lobes, which therefore see the probe
// itself (LightingStrategy::mirrorAlpha). A BSDF is the sum of its lobes of either kind, and each
// sum has samples, a pdf and MIS weights of its own.
enum class Lobes {
  Broad,
  Narrow,  // of GGX's alpha below the limit; perfect mirrors too, which evaluate() does not show
};

struct BsdfSample {
  vec3 wi;      // unit, away from the surface
  Rgb weight;   // f cos / pdf, both of the lobes that were sampled
  float pdf;    // over solid angle; 0 for a mirror's direction, which nothing else is to sample
  Lobes lobes;  // that were sampled
};

class ExtendedBsdf;

// glTF metallic-roughness (glTF 2.0, appendix B) at one point, seen from one direction. Reflection
// only, and reciprocal:
//   f = specular + diffuse (1 - S(wo))(1 - S(wi)) / (pi (1 - S_mean)) + multiple scattering
// The specular lobe is GGX; what its microfacets scatter again comes back as a diffuse-like lobe
// (Kulla and Conty 2017), and the diffuse base gets what the coating lets through (Kelemen and
// Szirmay-Kalos 2001), so that a white material reflects exactly all light. A material without
// specular reflection is Lambert's, and pays for nothing else. An extended material hides behind
// the same interface, and its sampled directions may lie on either side of the surface.
class Bsdf {
 public:
  // `wo`: unit, towards the viewer; the surface's normals are on its side. A specular lobe whose
  // alpha (roughness squared) is less than `mirrorAlpha` is a narrow one.
  Bsdf(const MaterialPoint& material, const Surface& surface, const vec3& wo, float mirrorAlpha = 0)
      : Bsdf(material, material.baseColor * (1 - material.metallic), material.baseColor, surface,
             wo, mirrorAlpha) {}

  // With the diffuse albedo and the metal's F0 in the base colour's stead.
  Bsdf(const MaterialPoint& material, const Rgb& diffuse, const Rgb& metalF0,
       const Surface& surface, const vec3& wo, float mirrorAlpha);

  // Stands for `extended`, which must outlive it.
  explicit Bsdf(const ExtendedBsdf& extended);

  struct Value {
    Rgb fCos;   // f times |cos| at the shading normal
    float pdf;  // of sample(), over solid angle
  };
  Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;

  // False where the sampled direction is absorbed. `lobe` in [0, 1) chooses the lobe.
  bool sample(vec2 u, float lobe, BsdfSample& out) const;

  // Whether evaluate() shows any such lobes, so that lights are worth sampling.
  bool has(Lobes lobes) const { return lobes == Lobes::Broad ? hasBroad_ : hasNarrow_; }
  const vec3& normal() const { return normal_; }
  // Whether light may also come from beyond the hemisphere of normal(): through the surface, or to
  // a layer with a normal of its own.
  bool isExtended() const { return extended_ != nullptr; }
  // Whether broad lobes pass light from behind.
  bool transmits() const { return transmits_; }

  // Luminance that is reflected of a uniform white surrounding.
  float albedo() const { return specular_ ? albedo_ : luminance(diffuse_); }
  // Share that the dielectric surface reflects, multiple scattering included: what a layer beneath
  // does not get.
  float surfaceAlbedo() const { return specular_ ? surfaceAlbedo_ : 0; }

 private:
  void initSpecular(const MaterialPoint& material, const Rgb& metalF0, const vec3& wo,
                    float mirrorAlpha);
  Value evaluateLobes(const vec3& wi, Lobes lobes) const;  // in the frame of the normal
  Rgb fresnel(float cosine) const;

  // Scalar form of the dielectric coating's albedo: S(mu) = f0 a + f90 b + again (1 - a - b).
  struct Coating {
    float f0, f90, again;
    float albedo(const SpecularAlbedo& s) const {
      return f0 * s.a + f90 * s.b + again * (1 - s.a - s.b);
    }
  };

  const ExtendedBsdf* extended_ = nullptr;  // answers in this one's stead where it is set
  vec3 normal_, geometricNormal_;
  Rgb diffuse_;  // albedo; with a coating, times (1 - S(wo)) / (1 - S_mean)
  bool hasBroad_ = true, hasNarrow_ = false, transmits_ = false;
  bool specular_;               // the members below hold only where this is set
  bool smooth_ = false;         // the specular lobe is a delta
  bool narrow_ = false;         // it is one, or narrower than the limit
  float specularFraction_ = 0;  // probability of sampling the specular lobe
  vec3 wo_;                     // in the frame of the normal
  Frame frame_;
  float alpha_;
  Rgb f0_, f90_;
  Rgb again_;  // multiple scattering, times (1 - E(wo)) / (1 - E_mean)
  Coating coating_;
  float albedo_, surfaceAlbedo_;
  EnergyTable::Row energy_;
};

// Completes a sample in direction out.wi, where out.lobes have `value`; false where none would have
// been sampled there. NaN goes on, to be counted.
inline bool completeSample(const Bsdf::Value& value, BsdfSample& out) {
  if (value.pdf <= 0) return false;
  out.weight = value.fCos / value.pdf;
  out.pdf = value.pdf;
  return true;
}

}  // namespace chromeball
