// SPDX-License-Identifier: Apache-2.0
#include "shading/metallic_roughness.h"

#include "math/warp.h"
#include "shading/bsdf_sample.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"

namespace chromeball {
namespace {

// Fraction of light that leaves after two or more bounces between microfacets whose mean albedo in
// one bounce is E: the sum over bounces F^2 E + F^3 E (1 - E) + ... = F^2 E / (1 - F (1 - E)), with
// Schlick's Fresnel term averaged over the cosine, F = F0 + (F90 - F0) / 21 (Kulla and Conty 2017).
template <class T>
T multipleScattering(const T& f0, const T& f90, float meanAlbedo) {
  const T mean = f0 + (f90 - f0) * (1.0f / 21);
  return mean * mean * meanAlbedo / (1.0f - mean * (1 - meanAlbedo));
}

}  // namespace

MetallicRoughness::MetallicRoughness(const MaterialPoint& m, const Rgb& diffuse, const Rgb& metalF0,
                                     const Surface& surface, const vec3& wo,
                                     const BsdfTables& tables, float mirrorAlpha)
    : frame_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      alpha_(m.roughness * m.roughness),
      smooth_(alpha_ < kSmoothAlpha),
      narrow_(smooth_ || alpha_ < mirrorAlpha),
      f0_(glm::mix(m.dielectricF0, metalF0, m.metallic)),
      f90_(glm::mix(m.dielectricF90, 1.0f, m.metallic)),
      energy_(tables.energy->row(m.roughness)) {
  // Not in the initialiser list: there the compiler fuses other multiplications and additions,
  // which changes images in their last bits.
  frame_ = Frame(normalThatReflects(surface.normal, surface.geometricNormal, wo));
  wo_ = frame_.toLocal(wo);
  wo_.z = std::max(wo_.z, 1e-6f);
  const SpecularAlbedo toViewer = energy_.at(wo_.z), mean = energy_.average();
  const float meanAlbedo = mean.a + mean.b;
  const Rgb multiple =
      glm::mix(multipleScattering(m.dielectricF0, Rgb(m.dielectricF90), meanAlbedo),
               multipleScattering(metalF0, Rgb(1), meanAlbedo), m.metallic);
  const float lost = 1 - toViewer.a - toViewer.b, meanLost = 1 - meanAlbedo;
  const Rgb multipleAlbedo = multiple * lost;
  multiple_ = meanLost > 1e-5f ? multipleAlbedo / meanLost : Rgb(0);

  const float dielectricF0 = maxComponent(m.dielectricF0);
  dielectric_ = {dielectricF0, m.dielectricF90,
                 multipleScattering(dielectricF0, m.dielectricF90, meanAlbedo)};
  surfaceAlbedo_ = dielectric_.albedo(toViewer);
  const Rgb diffuseAlbedo = diffuse * (1 - surfaceAlbedo_);
  const float through = 1 - dielectric_.albedo(mean);
  diffuse_ = through > 1e-5f ? diffuseAlbedo / through : Rgb(0);

  const float specular = luminance(f0_ * toViewer.a + f90_ * toViewer.b);
  const float rest = luminance(diffuseAlbedo + multipleAlbedo);
  albedo_ = specular + rest;
  specularProbability_ = albedo_ > 0 ? specular / albedo_ : 1;
  hasBroad_ = !narrow_ || specularProbability_ < 1;
  hasNarrow_ = narrow_ && !smooth_;
}

BsdfValue MetallicRoughness::evaluate(const vec3& wi, Lobes lobes) const {
  if (glm::dot(normal(), wi) <= 0 || glm::dot(geometricNormal_, wi) <= 0) return {Rgb(0), 0};
  return evaluateLocal(frame_.toLocal(wi), lobes);
}

BsdfValue MetallicRoughness::evaluateLocal(const vec3& wi, Lobes lobes) const {
  BsdfValue v{Rgb(0), 0};
  if (lobes == Lobes::Broad) {
    const float cosine = wi.z;
    const SpecularAlbedo toLight = energy_.at(cosine);
    v.fCos =
        (diffuse_ * (1 - dielectric_.albedo(toLight)) + multiple_ * (1 - toLight.a - toLight.b)) *
        (cosine * kInvPi);
    v.pdf = (1 - specularProbability_) * cosine * kInvPi;
  }
  if (smooth_ || narrow_ != (lobes == Lobes::Narrow)) return v;

  // Walter et al. 2007, eq. 20: f = F D G2 / (4 cos cos). The pdf: D G1 / (4 wo.z).
  const vec3 h = glm::normalize(wo_ + wi);
  const float d = ggx::distribution(h, alpha_) / (4 * wo_.z);
  const float lambdaO = ggx::lambda(wo_.z, alpha_);
  v.fCos += fresnelSchlick(f0_, f90_, std::min(glm::dot(wo_, h), 1.0f)) *
            (d / (1 + lambdaO + ggx::lambda(wi.z, alpha_)));
  v.pdf += specularProbability_ * d / (1 + lambdaO);
  return v;
}

bool MetallicRoughness::sample(vec2 u, float lobe, BsdfSample& out) const {
  if (!(lobe < specularProbability_)) {
    out.lobes = Lobes::Broad;
    out.isDiffuse = true;
    out.wi = frame_.toWorld(squareToCosineHemisphere(u));
    return completeSample(evaluate(out.wi, out.lobes), out);
  }
  out.lobes = narrow_ ? Lobes::Narrow : Lobes::Broad;
  out.isDiffuse = false;
  const vec3 h = smooth_ ? vec3(0, 0, 1) : ggx::sampleVisibleNormal(wo_, alpha_, u);
  const vec3 local = 2 * glm::dot(wo_, h) * h - wo_;
  if (local.z <= 0) return false;
  out.wi = frame_.toWorld(local);
  if (glm::dot(geometricNormal_, out.wi) <= 0) return false;
  if (smooth_)
    return completeDelta(fresnelSchlick(f0_, f90_, std::min(wo_.z, 1.0f)) / specularProbability_,
                         out);
  return completeSample(evaluate(out.wi, out.lobes), out);
}

void MetallicRoughness::addTo(MapLobes& lobes, float weight) const {
  const SpecularAlbedo toViewer = energy_.at(wo_.z), mean = energy_.average();
  const Rgb specular = smooth_ ? fresnelSchlick(f0_, f90_, std::min(wo_.z, 1.0f))
                               : f0_ * toViewer.a + f90_ * toViewer.b;
  const vec3 mirrored(-wo_.x, -wo_.y, wo_.z);
  lobes.add({weight * specular, glm::normalize(frame_.toWorld(mirrored)), false,
             smooth_ ? 0 : std::sqrt(alpha_)});
  const Rgb diffuse = diffuse_ * (1 - dielectric_.albedo(mean)) + multiple_ * (1 - mean.a - mean.b);
  if (!isBlack(diffuse)) lobes.addDiffuse(weight * diffuse, normal());
}

void MetallicRoughness::keepOnly(KeptLobes kept) {
  const float specular = specularProbability_ * albedo_;
  if (!kept.diffuse) {
    diffuse_ = multiple_ = Rgb(0);
    albedo_ = specular;
    specularProbability_ = 1;
    hasBroad_ = !narrow_;
  }
  if (!kept.specular) {
    f0_ = f90_ = Rgb(0);
    albedo_ -= specular;
    specularProbability_ = 0;
    hasNarrow_ = false;
  }
}

}  // namespace chromeball
