// SPDX-License-Identifier: Apache-2.0
// The sheen of cloth (KHR_materials_sheen): fibres that stand up from the surface.
#pragma once

#include <algorithm>

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

// The "Charlie" distribution of fibres that stand up from a surface, in the frame of the normal, +z
// (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF").
namespace charlie {

// The fit of the masking term is poor below this perceptual roughness.
inline constexpr float kMinRoughness = 0.1f;

// f |cos| of the white lobe, for unit directions above the surface: D G2 / (4 wo.z). `alpha`: the
// square of perceptual roughness.
float fCos(const vec3& wo, const vec3& wi, float alpha);

}  // namespace charlie

// Microfacets of the "Charlie" distribution. Roughness below 0.1 counts as 0.1.
class Sheen {
 public:
  Sheen(const Rgb& color, float roughness, const Surface& surface, const vec3& wo,
        const BsdfTables& tables);

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return lobes == Lobes::Broad; }
  float albedo() const { return luminance(color_) * whiteAlbedo_; }
  // Fraction of light that does not reach the layers beneath.
  float surfaceAlbedo() const { return std::min(maxComponent(color_) * whiteAlbedo_, 1.0f); }
  // Treats the sheen as if it were diffuse.
  void addTo(MapLobes& lobes, float weight) const {
    lobes.addDiffuse(weight * whiteAlbedo_ * color_, frame_.z);
  }
  void keepOnly(KeptLobes kept) {
    if (!kept.diffuse) color_ = Rgb(0);
  }

 private:
  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  Rgb color_;
  float alpha_;
  float whiteAlbedo_;  // of the lobe with the colour white
};

}  // namespace chromeball
