// SPDX-License-Identifier: Apache-2.0
// The sheen of cloth (KHR_materials_sheen): fibres that stand up from the surface.
#pragma once

#include <vector>

#include "math/frame.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {

// Albedo of the white sheen lobe.
class SheenTable {
 public:
  // Tabulated by quadrature once a process, on first use, which must not be inside a parallel loop.
  static const SheenTable& get();
  float albedo(float mu, float roughness) const;

 private:
  SheenTable();
  std::vector<float> cells_;  // kRoughnesses x kAngles
};

// Microfacets that stand upright rather than lie flat: the "Charlie" distribution and its masking
// (Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF"). Roughness below 0.1 counts
// as 0.1.
class Sheen {
 public:
  Sheen(const Rgb& color, float roughness, const Surface& surface, const vec3& wo);

  Bsdf::Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return lobes == Lobes::Broad; }
  float albedo() const { return luminance(color_) * albedo_; }
  // Share that what lies beneath does not get.
  float surfaceAlbedo() const { return maxComponent(color_) * albedo_; }

 private:
  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_;  // in the frame
  Rgb color_;
  float alpha_;
  float albedo_;  // of the white lobe
};

}  // namespace chromeball
