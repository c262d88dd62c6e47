// SPDX-License-Identifier: Apache-2.0
#include "shading/glass.h"

#include "math/warp.h"
#include "shading/bsdf_sample.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"

namespace chromeball {
namespace {

// Fresnel's reflectance at normal incidence.
float normalReflectance(float eta) {
  const float r = (eta - 1) / (eta + 1);
  return r * r;
}

// F0 of KHR_materials_specular over F0 of the index `front` against air. The same ratio is used in
// any surrounding medium, so that the reflectance of a body vanishes as its index approaches its
// surroundings'.
float specularTint(const MaterialPoint& m, int channel, float front) {
  const float own = normalReflectance(front);
  return own > 0 ? m.dielectricF0[channel] / own : m.dielectricF90;
}

}  // namespace

Glass::Glass(const MaterialPoint& m, const RefractiveIndex& index, const Surface& surface,
             const vec3& wo, const BsdfTables& tables, float mirrorAlpha)
    : frame_(normalThatReflects(surface.normal, surface.geometricNormal, wo)),
      geometricNormal_(surface.geometricNormal),
      wo_(frame_.toLocal(wo)),
      eta_(index.eta),
      dispersive_(eta_.x != eta_.y || eta_.y != eta_.z),
      tint_(m.baseColor),
      alpha_(m.roughness * m.roughness),
      gain_(1) {
  wo_.z = std::max(wo_.z, 1e-6f);
  for (int c = 0; c < 3; ++c) {
    const float own = normalReflectance(eta_[c]);
    const float f0 = std::min(own * specularTint(m, c, index.front), m.dielectricF90);
    slope_[c] = own < 1 ? (m.dielectricF90 - f0) / (1 - own) : 0;
    offset_[c] = f0 - slope_[c] * own;
  }
  smooth_ = alpha_ < kSmoothAlpha || maxComponent(glm::abs(eta_ - 1.0f)) < kMinRefraction;
  lobes_ = smooth_ || alpha_ < mirrorAlpha ? Lobes::Narrow : Lobes::Broad;
  lambdaO_ = ggx::lambda(wo_.z, alpha_);
  if (smooth_) return;
  const GlassTable& table = *tables.glass;
  GlassAlbedo once = table.albedo(wo_.z, m.roughness, eta_.x);
  for (int c = 0; c < 3; ++c) {
    if (c > 0 && dispersive_) once = table.albedo(wo_.z, m.roughness, eta_[c]);
    gain_[c] = 1 / once.at(offset_[c], slope_[c]);
  }
}

float Glass::fresnel(float cosine, int c) const {
  const float exact = fresnelDielectric(cosine, eta_[c]);
  if (exact >= 1) return 1;
  return glm::clamp(offset_[c] + slope_[c] * exact, 0.0f, 1.0f);
}

Rgb Glass::fresnel(float cosine) const {
  return {fresnel(cosine, 0), fresnel(cosine, 1), fresnel(cosine, 2)};
}

float Glass::albedo() const {
  const Rgb reflectance = fresnel(wo_.z);
  return luminance(reflectance + (1.0f - reflectance) * tint_);
}

BsdfValue Glass::evaluate(const vec3& wi, Lobes lobes) const {
  if (!has(lobes)) return {Rgb(0), 0};
  const vec3 local = frame_.toLocal(wi);
  const bool above = local.z > 0;
  if (local.z == 0 || above != (glm::dot(geometricNormal_, wi) > 0)) return {Rgb(0), 0};
  if (above) return reflect(local);
  if (!dispersive_) return refract(local, 0);
  BsdfValue sum{Rgb(0), 0};
  for (int c = 0; c < 3; ++c) {
    const BsdfValue v = refract(local, c);
    sum.fCos[c] = v.fCos[c];
    sum.pdf += v.pdf / 3;
  }
  return sum;
}

// Walter et al. 2007, eq. 20.
BsdfValue Glass::reflect(const vec3& wi) const {
  const vec3 h = glm::normalize(wo_ + wi);
  const Rgb reflectance = fresnel(std::min(glm::dot(wo_, h), 1.0f));
  const float d = ggx::distribution(h, alpha_) / (4 * wo_.z);
  return {reflectance * (gain_ * d / (1 + lambdaO_ + ggx::lambda(wi.z, alpha_))),
          reflectProbability(reflectance) * d / (1 + lambdaO_)};
}

// Walter et al. 2007, eq. 16, 17 and 21: h = -(wo + eta wi) normalized, and
//   dh/dwi = eta^2 |wi.h| / (wo.h + eta wi.h)^2.
BsdfValue Glass::refract(const vec3& wi, int c) const {
  vec3 h = wo_ + eta_[c] * wi;
  h *= (h.z < 0 ? -1 : 1) / glm::length(h);
  const float woH = glm::dot(wo_, h), wiH = glm::dot(wi, h);
  if (!(woH > 0 && wiH < 0)) return {Rgb(0), 0};
  const float sum = woH + eta_[c] * wiH;
  const float jacobian = eta_[c] * eta_[c] * -wiH / (sum * sum);
  const float d = ggx::distribution(h, alpha_) * woH / wo_.z * jacobian;
  const Rgb reflectance = fresnel(std::min(woH, 1.0f));
  const float g2 = 1 / (1 + lambdaO_ + ggx::lambda(-wi.z, alpha_));
  return {tint_ * (1.0f - reflectance) * (gain_ * d * g2),
          (1 - reflectProbability(reflectance)) * d / (1 + lambdaO_)};
}

bool Glass::sample(vec2 u, float lobe, BsdfSample& out) const {
  const vec3 h = smooth_ ? vec3(0, 0, 1) : ggx::sampleVisibleNormal(wo_, alpha_, u);
  const float woH = glm::dot(wo_, h);
  const Rgb reflectance = fresnel(std::min(woH, 1.0f));
  const float reflected = reflectProbability(reflectance);
  vec3 local;
  Rgb weight;
  if (lobe < reflected) {
    local = 2 * woH * h - wo_;
    if (local.z <= 0) return false;
    weight = reflectance / reflected;
  } else {
    const float choice = (lobe - reflected) / (1 - reflected);
    const int c = dispersive_ ? std::min(int(3 * choice), 2) : 0;
    if (reflectance[c] >= 1) return false;
    local = refracted(wo_, h, eta_[c]);
    if (local.z >= 0) return false;
    weight = tint_ * (1.0f - reflectance) / (1 - reflected);
    if (dispersive_) {
      const float own = 3 * weight[c];
      weight = Rgb(0);
      weight[c] = own;
    }
  }
  out.wi = frame_.toWorld(local);
  if ((local.z > 0) != (glm::dot(geometricNormal_, out.wi) > 0)) return false;
  out.lobes = lobes_;
  out.isDiffuse = false;
  if (smooth_) return completeDelta(weight, out);
  return completeSample(evaluate(out.wi, lobes_), out);
}

void Glass::addTo(MapLobes& lobes, float weight) const {
  const Rgb reflectance = fresnel(std::min(wo_.z, 1.0f));
  const float roughness = smooth_ ? 0 : std::sqrt(alpha_);
  const vec3 mirrored(-wo_.x, -wo_.y, wo_.z);
  lobes.add({weight * reflectance, glm::normalize(frame_.toWorld(mirrored)), false, roughness});
  const Rgb transmitted = tint_ * (1.0f - reflectance);
  if (isBlack(transmitted)) return;
  const vec3 through = frame_.toWorld(refracted(wo_, vec3(0, 0, 1), eta_.y));
  lobes.add({weight * transmitted, glm::normalize(through), false, roughness});
}

Sheet::Sheet(const Rgb& fraction, float roughness, const Surface& surface, const vec3& wo,
             const BsdfTables& tables, float mirrorAlpha)
    : frame_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      wo_(wo),
      localWo_(frame_.toLocal(wo)),
      fraction_(fraction),
      alpha_(roughness * roughness),
      smooth_(alpha_ < kSmoothAlpha),
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
