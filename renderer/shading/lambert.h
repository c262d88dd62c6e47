// SPDX-License-Identifier: Apache-2.0
// Perfectly diffuse reflection.
#pragma once

#include "math/vec.h"
#include "scene/surface.h"
#include "shading/bsdf_sample.h"

namespace chromeball {

// f = albedo / pi.
class Lambert {
 public:
  Lambert(const Rgb& albedo, const vec3& normal, const vec3& geometricNormal)
      : albedo_(albedo), geometricNormal_(geometricNormal), frame_(normal) {}

  BsdfValue evaluate(const vec3& wi, Lobes lobes = Lobes::Broad) const;
  bool sample(vec2 u, float lobe, BsdfSample& out) const;
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
