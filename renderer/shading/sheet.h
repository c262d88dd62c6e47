// SPDX-License-Identifier: Apache-2.0
// Transmission through a sheet without thickness (KHR_materials_transmission without a volume).
#pragma once

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"
#include "shading/bsdf_tables.h"

namespace chromeball {

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
    if (!kept.specular && !smooth_) fraction_ = Rgb(0);
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
