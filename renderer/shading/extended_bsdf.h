// SPDX-License-Identifier: Apache-2.0
// The BSDF of a material with extensions: layers and lobes beside metallic-roughness.
#pragma once

#include <optional>

#include "scene/extended_surface.h"
#include "shading/brushed.h"
#include "shading/glass.h"
#include "shading/sheen.h"
#include "shading/sheet.h"

namespace chromeball {

// Makes the tables that the material will ask for.
void prepareExtendedBsdf(const Material& material);

// Lobes that each conserve energy, with the share of light that each gets:
//   a clear coat of index 1.5, which lets 1 - (its albedo) through to what lies beneath;
//   sheen, which does the same;
//   the base: metallic-roughness, brushed where it is anisotropic, of which a share `transmission`
//   of the dielectric is glass, or, for a sheet without thickness, of which that share of the
//   diffuse light passes. A thin film changes the base's F0 to what it reflects under the viewer's
//   angle: exact where the base is smooth. What it does not reflect of a colour reaches the diffuse
//   light in that colour. Glass ignores anisotropy.
// Layers look at the viewer's direction alone, as the extensions' simple forms do: that keeps the
// energy exactly, and costs reciprocity.
class ExtendedBsdf {
 public:
  ExtendedBsdf(const MaterialPoint& material, const ExtendedPoint& extended,
               const RefractiveIndex& index, const Surface& surface, const vec3& wo,
               float mirrorAlpha);

  Bsdf::Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return lobes == Lobes::Broad ? hasBroad_ : hasNarrow_; }
  // Whether broad lobes pass light from behind.
  bool transmits() const {
    return (glass_ && glass_->lobe.has(Lobes::Broad)) || (sheet_ && sheet_->lobe.has(Lobes::Broad));
  }
  const vec3& normal() const { return normal_; }

 private:
  // One lobe, the factor on it, and the probability of sampling it.
  template <class Lobe>
  struct Part {
    Lobe lobe;
    float factor, fraction;
  };
  template <class Self, class Function>
  static void forEachPart(Self& self, Function&& function);
  // Samples one part, with a number that says which of its own lobes.
  template <class Lobe>
  bool samplePart(const Part<Lobe>& part, vec2 u, float lobe, BsdfSample& out) const;
  void addBase(const MaterialPoint& material, const Rgb& metalF0, const ExtendedPoint& extended,
               const RefractiveIndex& index, const Surface& surface, const vec3& wo,
               float mirrorAlpha, float factor);
  // Metallic-roughness; returns what its dielectric surface reflects.
  Rgb addMetallicRoughness(const MaterialPoint& material, const Rgb& diffuse, const Rgb& metalF0,
                           const ExtendedPoint& extended, const Surface& surface, const vec3& wo,
                           float mirrorAlpha, float factor);

  vec3 normal_;
  bool hasBroad_ = false, hasNarrow_ = false;
  std::optional<Part<Bsdf>> coat_, base_, underFilm_;
  std::optional<Part<Brushed>> brushed_;
  std::optional<Part<Sheen>> sheen_;
  std::optional<Part<Glass>> glass_;
  std::optional<Part<Sheet>> sheet_;
};

}  // namespace chromeball
