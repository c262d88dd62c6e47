// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf.h"

#include "math/warp.h"
#include "shading/extended_bsdf.h"
#include "shading/ggx.h"
#include "shading/shading_normal.h"

namespace chromeball {
namespace {

// Fraction that leaves after two or more bounces between microfacets (Kulla and Conty 2017).
template <class T>
T scatteredAgain(const T& f0, const T& f90, float meanAlbedo) {
  const T mean = f0 + (f90 - f0) * (1.0f / 21);
  return mean * mean * meanAlbedo / (1.0f - mean * (1 - meanAlbedo));
}

}  // namespace

void prepareBsdfs(const Scene& scene) {
  for (const Material& m : scene.materials) {
    if (m.metallic > 0 || m.specular > 0) EnergyTable::get();
    if (m.extended) prepareExtendedBsdf(m);
  }
}

Bsdf::Bsdf(const MaterialPoint& m, const Rgb& diffuse, const Rgb& metalF0, const Surface& surface,
           const vec3& wo, float mirrorAlpha)
    : normal_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      diffuse_(diffuse),
      specular_(m.metallic > 0 || m.dielectricF90 > 0),
      frame_(normal_) {
  if (specular_) initSpecular(m, metalF0, wo, mirrorAlpha);
}

Bsdf::Bsdf(const ExtendedBsdf& extended)
    : extended_(&extended), normal_(extended.normal()), specular_(false), frame_(normal_) {
  hasBroad_ = extended.has(Lobes::Broad);
  hasNarrow_ = extended.has(Lobes::Narrow);
  transmits_ = extended.transmits();
}

void Bsdf::initSpecular(const MaterialPoint& m, const Rgb& metalF0, const vec3& wo,
                        float mirrorAlpha) {
  normal_ = normalThatReflects(normal_, geometricNormal_, wo);
  frame_ = Frame(normal_);
  wo_ = frame_.toLocal(wo);
  wo_.z = std::max(wo_.z, 1e-6f);
  alpha_ = m.roughness * m.roughness;
  smooth_ = alpha_ < ggx::kSmoothAlpha;
  narrow_ = smooth_ || alpha_ < mirrorAlpha;
  f0_ = glm::mix(m.dielectricF0, metalF0, m.metallic);
  f90_ = Rgb(glm::mix(m.dielectricF90, 1.0f, m.metallic));

  energy_ = EnergyTable::get().row(m.roughness);
  const SpecularAlbedo toViewer = energy_.at(wo_.z), mean = energy_.average();
  const float meanAlbedo = mean.a + mean.b;
  const Rgb again = glm::mix(scatteredAgain(m.dielectricF0, Rgb(m.dielectricF90), meanAlbedo),
                             scatteredAgain(metalF0, Rgb(1), meanAlbedo), m.metallic);
  const float lost = 1 - toViewer.a - toViewer.b, meanLost = 1 - meanAlbedo;
  const Rgb againAlbedo = again * lost;
  again_ = meanLost > 1e-5f ? againAlbedo / meanLost : Rgb(0);

  const float coatF0 = maxComponent(m.dielectricF0);
  coating_ = {coatF0, m.dielectricF90, scatteredAgain(coatF0, m.dielectricF90, meanAlbedo)};
  surfaceAlbedo_ = coating_.albedo(toViewer);
  const Rgb diffuseAlbedo = diffuse_ * (1 - surfaceAlbedo_);
  const float through = 1 - coating_.albedo(mean);
  diffuse_ = through > 1e-5f ? diffuseAlbedo / through : Rgb(0);

  const float specular = luminance(f0_ * toViewer.a + f90_ * toViewer.b);
  const float rest = luminance(diffuseAlbedo + againAlbedo);
  albedo_ = specular + rest;
  specularFraction_ = albedo_ > 0 ? specular / albedo_ : 1;
  hasBroad_ = !narrow_ || specularFraction_ < 1;
  hasNarrow_ = narrow_ && !smooth_;
}

Rgb Bsdf::fresnel(float cosine) const {
  const float c = 1 - cosine, c2 = c * c;
  return f0_ + (f90_ - f0_) * (c2 * c2 * c);
}

Bsdf::Value Bsdf::evaluate(const vec3& wi, Lobes lobes) const {
  if (extended_) [[unlikely]]
    return extended_->evaluate(wi, lobes);
  const float cosine = glm::dot(normal_, wi);
  if (cosine <= 0 || glm::dot(geometricNormal_, wi) <= 0) return {Rgb(0), 0};
  if (specular_) return evaluateLobes(frame_.toLocal(wi), lobes);
  if (lobes == Lobes::Narrow) return {Rgb(0), 0};
  return {diffuse_ * (cosine * kInvPi), cosine * kInvPi};
}

Bsdf::Value Bsdf::evaluateLobes(const vec3& wi, Lobes lobes) const {
  Value v{Rgb(0), 0};
  if (lobes == Lobes::Broad) {
    const float cosine = wi.z;
    const SpecularAlbedo toLight = energy_.at(cosine);
    v.fCos = (diffuse_ * (1 - coating_.albedo(toLight)) + again_ * (1 - toLight.a - toLight.b)) *
             (cosine * kInvPi);
    v.pdf = (1 - specularFraction_) * cosine * kInvPi;
  }
  if (smooth_ || narrow_ != (lobes == Lobes::Narrow)) return v;

  const vec3 h = glm::normalize(wo_ + wi);
  const float d = ggx::distribution(h, alpha_) / (4 * wo_.z);
  const float lambdaO = ggx::lambda(wo_.z, alpha_);
  v.fCos +=
      fresnel(std::min(glm::dot(wo_, h), 1.0f)) * (d / (1 + lambdaO + ggx::lambda(wi.z, alpha_)));
  v.pdf += specularFraction_ * d / (1 + lambdaO);
  return v;
}

bool Bsdf::sample(vec2 u, float lobe, BsdfSample& out) const {
  if (extended_) [[unlikely]]
    return extended_->sample(u, lobe, out);
  out.lobes = Lobes::Broad;
  if (specular_ && lobe < specularFraction_) {
    if (narrow_) out.lobes = Lobes::Narrow;
    const vec3 h = smooth_ ? vec3(0, 0, 1) : ggx::sampleVisibleNormal(wo_, alpha_, u);
    const vec3 local = 2 * glm::dot(wo_, h) * h - wo_;
    if (local.z <= 0) return false;
    out.wi = frame_.toWorld(local);
    if (glm::dot(geometricNormal_, out.wi) <= 0) return false;
    if (smooth_) {
      out.weight = fresnel(std::min(wo_.z, 1.0f)) / specularFraction_;
      out.pdf = 0;
      return true;
    }
  } else {
    out.wi = frame_.toWorld(squareToCosineHemisphere(u));
    if (!specular_) {
      out.weight = diffuse_;
      out.pdf = glm::dot(normal_, out.wi) * kInvPi;
      return out.pdf > 0 && glm::dot(geometricNormal_, out.wi) > 0;
    }
  }
  return completeSample(evaluate(out.wi, out.lobes), out);
}

}  // namespace chromeball
