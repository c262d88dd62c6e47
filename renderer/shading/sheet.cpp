// SPDX-License-Identifier: Apache-2.0
#include "shading/sheet.h"

#include "shading/ggx.h"

namespace chromeball {

Sheet::Sheet(const Rgb& fraction, float roughness, const Surface& surface, const vec3& wo,
             const BsdfTables& tables, float mirrorAlpha)
    : frame_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      wo_(wo),
      localWo_(frame_.toLocal(wo)),
      fraction_(fraction),
      alpha_(roughness * roughness),
      smooth_(alpha_ < ggx::kSmoothAlpha),
      lobes_(smooth_ || alpha_ < mirrorAlpha ? Lobes::Narrow : Lobes::Broad),
      gain_(1) {
  localWo_.z = std::max(localWo_.z, 1e-6f);
  lambdaO_ = ggx::lambda(localWo_.z, alpha_);
  if (smooth_) return;
  const SpecularAlbedo white = tables.energy->row(roughness).at(localWo_.z);
  gain_ = 1 / (white.a + white.b);
}

BsdfValue Sheet::evaluate(const vec3& wi, Lobes lobes) const {
  vec3 local = frame_.toLocal(wi);
  if (!has(lobes) || local.z >= 0 || glm::dot(geometricNormal_, wi) >= 0) return {Rgb(0), 0};
  local.z = -local.z;
  const vec3 h = glm::normalize(localWo_ + local);
  const float d = ggx::distribution(h, alpha_) / (4 * localWo_.z);
  return {fraction_ * (gain_ * d / (1 + lambdaO_ + ggx::lambda(local.z, alpha_))),
          d / (1 + lambdaO_)};
}

bool Sheet::sample(vec2 u, float, BsdfSample& out) const {
  out.isDiffuse = false;
  if (smooth_) {
    out.wi = -wo_;
    out.lobes = lobes_;
    return completeDelta(fraction_, out);
  }
  const vec3 h = ggx::sampleVisibleNormal(localWo_, alpha_, u);
  vec3 local = 2 * glm::dot(localWo_, h) * h - localWo_;
  if (local.z <= 0) return false;
  local.z = -local.z;
  out.wi = frame_.toWorld(local);
  if (glm::dot(geometricNormal_, out.wi) >= 0) return false;
  out.lobes = lobes_;
  return completeSample(evaluate(out.wi, lobes_), out);
}

}  // namespace chromeball
