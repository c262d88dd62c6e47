// SPDX-License-Identifier: Apache-2.0
// Perfectly diffuse reflection.
#pragma once

#include "math/vec.h"
#include "math/warp.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"

namespace chromeball {

// f = albedo / pi.
class Lambert {
 public:
  Lambert(const Rgb& albedo, const vec3& normal, const vec3& geometricNormal)
      : albedo_(albedo), geometricNormal_(geometricNormal), frame_(normal) {}

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const {
    const float cosine = glm::dot(normal(), wi);
    if (cosine <= 0 || glm::dot(geometricNormal_, wi) <= 0) return {Rgb(0), 0};
    if (lobes == Lobes::Narrow) return {Rgb(0), 0};
    return {albedo_ * (cosine * kInvPi), cosine * kInvPi};
  }
  bool sample(vec2 u, float, BsdfSample& out) const {
    out.wi = frame_.toWorld(squareToCosineHemisphere(u));
    out.weight = albedo_;
    out.pdf = glm::dot(normal(), out.wi) * kInvPi;
    out.lobes = Lobes::Broad;
    out.isDelta = false;
    out.isDiffuse = true;
    return out.pdf > 0 && glm::dot(geometricNormal_, out.wi) > 0;
  }
  bool has(Lobes lobes) const { return lobes == Lobes::Broad; }
  bool transmits() const { return false; }
  const vec3& normal() const { return frame_.z; }

  float albedo() const { return luminance(albedo_); }
  float surfaceAlbedo() const { return 0; }

  void addTo(MapLobes& lobes, float weight) const { lobes.addDiffuse(weight * albedo_, normal()); }
  void keepOnly(KeptLobes kept) {
    if (!kept.diffuse) albedo_ = Rgb(0);
  }

 private:
  Rgb albedo_;
  vec3 geometricNormal_;
  Frame frame_;
};

}  // namespace chromeball
