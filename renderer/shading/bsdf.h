// SPDX-License-Identifier: Apache-2.0
// The BSDF of a surface at one point, for one viewing direction: a closed set of types.
#pragma once

#include <concepts>
#include <variant>

#include "shading/lambert.h"
#include "shading/layered.h"
#include "shading/metallic_roughness.h"

namespace chromeball {

// The interface of every BSDF of the set.
template <class T>
concept ScattersLight = requires(const T bsdf, const vec3& wi, Lobes lobes, vec2 u, float lobe,
                                 BsdfSample& out, MapLobes& mapLobes) {
  // f |cos| and pdf of the lobes of this kind, for a unit direction; 0 for delta lobes.
  { bsdf.evaluate(wi, lobes) } -> std::same_as<BsdfValue>;
  // Chooses a direction by `u`, and by `lobe` in [0, 1) one of several lobes. False if the
  // light is absorbed.
  { bsdf.sample(u, lobe, out) } -> std::same_as<bool>;
  // Whether evaluate() can be above 0 for these lobes; if not, light samples are not needed.
  { bsdf.has(lobes) } -> std::same_as<bool>;
  // Whether broad lobes transmit light from behind.
  { bsdf.transmits() } -> std::same_as<bool>;
  // Shading normal, unit, on the viewer's side.
  { bsdf.normal() } -> std::same_as<const vec3&>;
  // Adds the lobes as environment mapping needs them, times a weight.
  { bsdf.addTo(mapLobes, lobe) } -> std::same_as<void>;
};
static_assert(ScattersLight<Lambert> && ScattersLight<MetallicRoughness> && ScattersLight<Layered>);

// A std::variant over the set: only the type that the material needs is constructed.
class Bsdf {
 public:
  // The BSDF of a plain material: Lambert if it has no specular reflection. `wo`: unit, towards the
  // viewer; the surface's normals are on its side. A specular lobe is narrow if its alpha
  // (roughness squared) is below `mirrorAlpha`. The tables must outlive the BSDF.
  Bsdf(const MaterialPoint& material, const Surface& surface, const vec3& wo,
       const BsdfTables& tables, float mirrorAlpha = 0)
      : set_(plain(material, surface, wo, tables, mirrorAlpha)) {}

  // The BSDF of a material with extensions.
  Bsdf(const MaterialPoint& material, const ExtendedPoint& extended, const RefractiveIndex& index,
       const Surface& surface, const vec3& wo, const BsdfTables& tables, float mirrorAlpha = 0)
      : set_(std::in_place_type<Layered>, material, extended, index, surface, wo, tables,
             mirrorAlpha) {}

  // See ScattersLight.
  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const {
    return std::visit([&](const auto& bsdf) { return bsdf.evaluate(wi, lobes); }, set_);
  }
  bool sample(vec2 u, float lobe, BsdfSample& out) const {
    return std::visit([&](const auto& bsdf) { return bsdf.sample(u, lobe, out); }, set_);
  }
  bool has(Lobes lobes) const {
    return std::visit([&](const auto& bsdf) { return bsdf.has(lobes); }, set_);
  }
  bool transmits() const {
    return std::visit([](const auto& bsdf) { return bsdf.transmits(); }, set_);
  }
  const vec3& normal() const {
    return std::visit([](const auto& bsdf) -> const vec3& { return bsdf.normal(); }, set_);
  }

  MapLobes mapLobes() const {
    MapLobes lobes;
    std::visit([&](const auto& bsdf) { bsdf.addTo(lobes, 1); }, set_);
    return lobes;
  }

  // Removes the other lobes; the remaining ones stay as they were.
  void keepOnly(KeptLobes kept) {
    std::visit([&](auto& bsdf) { bsdf.keepOnly(kept); }, set_);
  }

  // Whether light may also come from beyond the hemisphere of normal(): through the surface, or to
  // a layer with a normal of its own.
  bool isLayered() const { return std::holds_alternative<Layered>(set_); }

 private:
  using Set = std::variant<Lambert, MetallicRoughness, Layered>;

  static Set plain(const MaterialPoint& m, const Surface& surface, const vec3& wo,
                   const BsdfTables& tables, float mirrorAlpha) {
    if (m.metallic > 0 || m.dielectricF90 > 0)
      return Set(std::in_place_type<MetallicRoughness>, m, surface, wo, tables, mirrorAlpha);
    return Set(std::in_place_type<Lambert>, m.baseColor * (1 - m.metallic), surface.normal,
               surface.geometricNormal);
  }

  Set set_;
};

}  // namespace chromeball
