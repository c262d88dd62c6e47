// SPDX-License-Identifier: Apache-2.0
#include "shading/lambert.h"

#include "math/warp.h"

namespace chromeball {

BsdfValue Lambert::evaluate(const vec3& wi, Lobes lobes) const {
  const float cosine = glm::dot(normal(), wi);
  if (cosine <= 0 || glm::dot(geometricNormal_, wi) <= 0) return {Rgb(0), 0};
  if (lobes == Lobes::Narrow) return {Rgb(0), 0};
  return {albedo_ * (cosine * kInvPi), cosine * kInvPi};
}

bool Lambert::sample(vec2 u, float, BsdfSample& out) const {
  out.wi = frame_.toWorld(squareToCosineHemisphere(u));
  out.weight = albedo_;
  out.pdf = glm::dot(normal(), out.wi) * kInvPi;
  out.lobes = Lobes::Broad;
  out.isDelta = false;
  out.isDiffuse = true;
  return out.pdf > 0 && glm::dot(geometricNormal_, out.wi) > 0;
}

}  // namespace chromeball
