// SPDX-License-Identifier: Apache-2.0
// What a sheet without thickness lets through: KHR_materials_transmission without a volume.
#pragma once

#include "math/frame.h"
#include "scene/surface.h"
#include "shading/bsdf.h"

namespace chromeball {

// The specular lobe of the sheet's roughness seen in a mirror behind the sheet, so that the light
// is not bent, and scaled to let `fraction` of it through (KHR_materials_transmission, "Specular
// BTDF"). A smooth sheet passes light straight.
class Sheet {
 public:
  // `fraction`: by channel, of the light that `material`'s surface does not reflect; for a smooth
  // sheet, of all light.
  Sheet(const Rgb& fraction, float roughness, const Surface& surface, const vec3& wo,
        float mirrorAlpha);

  Bsdf::Value evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
  bool has(Lobes lobes) const { return !smooth_ && lobes == lobes_; }
  float albedo() const { return luminance(fraction_); }

 private:
  Frame frame_;
  vec3 geometricNormal_;
  vec3 wo_, localWo_;  // in the world and in the frame
  Rgb fraction_;
  float alpha_, lambdaO_;
  bool smooth_;
  Lobes lobes_;  // what it is
  float gain_;   // 1 / albedo in one bounce of a white lobe
};

}  // namespace chromeball
