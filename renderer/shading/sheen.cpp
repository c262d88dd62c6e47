// SPDX-License-Identifier: Apache-2.0
#include "shading/sheen.h"

#include "math/warp.h"
#include "shading/charlie.h"

namespace chromeball {

Sheen::Sheen(const Rgb& color, float roughness, const Surface& surface, const vec3& wo,
             const BsdfTables& tables)
    : frame_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      wo_(frame_.toLocal(wo)),
      color_(color) {
  wo_.z = std::max(wo_.z, 1e-4f);
  const float r = std::max(roughness, charlie::kMinRoughness);
  alpha_ = r * r;
  whiteAlbedo_ = tables.sheen->albedo(wo_.z, r);
  // The fit of the masking term reflects too much at grazing angles.
  if (whiteAlbedo_ > 1) color_ /= whiteAlbedo_;
}

BsdfValue Sheen::evaluate(const vec3& wi, Lobes lobes) const {
  const vec3 local = frame_.toLocal(wi);
  if (lobes == Lobes::Narrow || local.z <= 0 || glm::dot(geometricNormal_, wi) <= 0)
    return {Rgb(0), 0};
  return {color_ * charlie::fCos(wo_, local, alpha_), squareToUniformHemispherePdf(local)};
}

bool Sheen::sample(vec2 u, float, BsdfSample& out) const {
  out.lobes = Lobes::Broad;
  out.isDiffuse = true;
  out.wi = frame_.toWorld(squareToUniformHemisphere(u));
  return completeSample(evaluate(out.wi), out);
}

}  // namespace chromeball
