// SPDX-License-Identifier: Apache-2.0
#include "shading/sheen.h"

#include "math/warp.h"

namespace chromeball::charlie {
namespace {

// D(h): pdf of the fibres' normals per solid angle and projected area, for h.z = z (eq. 2). Its
// maximum is perpendicular to the surface normal.
float distribution(float z, float alpha) {
  const float sine = std::sqrt(std::max(0.0f, 1 - z * z));
  return (2 + 1 / alpha) * std::pow(sine, 1 / alpha) * (0.5f * kInvPi);
}

// A fit to Smith's Lambda for a direction w with w.z = z (eq. 3 and table 1). Rounding errors may
// make z > 1.
float lambda(float z, float alpha) {
  const float t = (1 - alpha) * (1 - alpha);
  const auto between = [t](float rough, float smooth) { return rough + t * (smooth - rough); };
  const float a = between(21.5473f, 25.3245f), b = between(3.82987f, 3.32435f);
  const float c = between(0.19823f, 0.16801f), d = between(-1.97760f, -1.27393f);
  const float e = between(-4.32054f, -4.85967f);
  const auto fit = [&](float x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return z < 0.5f ? std::exp(fit(z)) : std::exp(2 * fit(0.5f) - fit(std::max(1 - z, 0.0f)));
}

}  // namespace

float fCos(const vec3& wo, const vec3& wi, float alpha) {
  const vec3 h = glm::normalize(wo + wi);
  return distribution(h.z, alpha) / (4 * wo.z * (1 + lambda(wo.z, alpha) + lambda(wi.z, alpha)));
}

}  // namespace chromeball::charlie

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
