// SPDX-License-Identifier: Apache-2.0
// The BSDF of materials with glTF extensions: layers and lobes besides metallic-roughness.
#pragma once

#include <optional>

#include "scene/extended_surface.h"
#include "shading/brushed.h"
#include "shading/glass.h"
#include "shading/lambert.h"
#include "shading/metallic_roughness.h"
#include "shading/sheen.h"

namespace chromeball {

// A weighted sum of lobes that each conserve energy. From the outside in:
//   a clear coat of index 1.5, which transmits 1 - (its albedo) to the layers beneath;
//   sheen, likewise;
//   the base: metallic-roughness, or brushed if it is anisotropic. The fraction `transmission` of
//   its dielectric part is glass (which ignores anisotropy); in a sheet without thickness, this
//   fraction of the diffuse light is transmitted instead.
// A thin film replaces the F0 of the base by the film's reflectance at the viewing angle (exact for
// a smooth base). Light that it does not reflect, per channel, reaches the diffuse base.
// The attenuation of layers depends only on the viewing direction, as in the simple forms of the
// extensions: that conserves energy exactly but is not reciprocal.
class Layered {
 public:
  // The arguments are as for MetallicRoughness.
  Layered(const MaterialPoint& material, const ExtendedPoint& extended,
          const RefractiveIndex& index, const Surface& surface, const vec3& wo,
          const BsdfTables& tables, float mirrorAlpha = 0);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return lobes == Lobes::Broad ? hasBroad_ : hasNarrow_; }
  bool transmits() const {
    return (glass_ && glass_->lobe.has(Lobes::Broad)) || (sheet_ && sheet_->lobe.has(Lobes::Broad));
  }
  const vec3& normal() const { return normal_; }
  void addTo(MapLobes& lobes, float weight) const;
  void keepOnly(KeptLobes kept);

 private:
  template <class Lobe>
  struct Weighted {
    Lobe lobe;
    float weight;
    float probability;  // of sampling the lobe
  };
  // The inputs of all lobes at the point.
  struct Point {
    const ExtendedPoint& extended;
    const RefractiveIndex& index;
    const Surface& surface;
    const vec3& wo;
    const BsdfTables& tables;
    float mirrorAlpha;
  };

  // Calls function(Weighted<Lobe>&) for each lobe that exists, always in the same order.
  template <class Self, class Function>
  static void forEachLobe(Self& self, Function&& function);
  template <class Lobe>
  void add(std::optional<Weighted<Lobe>>& to, const Lobe& lobe, float weight) {
    to = {lobe, weight, weight * lobe.albedo()};
  }
  // Samples one lobe; `choice` in [0, 1) chooses among the lobe's own.
  template <class Lobe>
  bool sampleLobe(const Weighted<Lobe>& part, vec2 u, float choice, BsdfSample& out) const;

  void addBase(const Point& point, const MaterialPoint& material, const Rgb& metalF0, float weight);
  // Adds metallic-roughness, brushed or Lambert; returns the reflectance of the dielectric surface.
  Rgb addOpaque(const Point& point, const MaterialPoint& material, const Rgb& diffuse,
                const Rgb& metalF0, float weight);
  // `lobeOf` makes the lobe for a MaterialPoint.
  template <class Lobe, class LobeOf>
  Rgb addOpaqueLobe(std::optional<Weighted<Lobe>>& to, const Point& point,
                    const MaterialPoint& material, const Rgb& diffuse, float weight,
                    const LobeOf& lobeOf);

  void chooseProbabilities();

  vec3 normal_;
  bool hasBroad_ = false, hasNarrow_ = false;
  std::optional<Weighted<MetallicRoughness>> coat_, metallicRoughness_;
  std::optional<Weighted<Brushed>> brushed_;
  std::optional<Weighted<Lambert>> lambert_;  // a base without specular, or light under a film
  std::optional<Weighted<Sheen>> sheen_;
  std::optional<Weighted<Glass>> glass_;
  std::optional<Weighted<Sheet>> sheet_;
};

}  // namespace chromeball
