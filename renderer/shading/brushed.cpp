// SPDX-License-Identifier: Apache-2.0
#include "shading/brushed.h"

#include "math/warp.h"
#include "shading/bsdf_sample.h"
#include "shading/fresnel.h"
#include "shading/ggx.h"

namespace chromeball {

Brushed::Brushed(const MaterialPoint& m, const Rgb& diffuse, const Rgb& metalF0, float strength,
                 const vec3& tangent, const Surface& surface, const vec3& wo,
                 const BsdfTables& tables, float mirrorAlpha)
    : frame_(normalThatReflects(surface.normal, surface.geometricNormal, wo), tangent),
      geometricNormal_(surface.geometricNormal),
      wo_(frame_.toLocal(wo)),
      alpha_(ggx::anisotropicAlpha(m.roughness, strength)) {
  wo_.z = std::max(wo_.z, 1e-6f);
  lambdaO_ = ggx::lambda(wo_, alpha_);
  narrow_ = std::max(alpha_.x, alpha_.y) < mirrorAlpha;
  const SpecularAlbedo once = tables.anisotropic->albedo(wo_, m.roughness, strength);
  const float white = once.a + once.b;
  const auto gain = [white](const auto& f0) { return 1.0f + f0 * ((1 - white) / white); };
  // Each part has its own gain: the mixture's gain would be less than the mixture of both gains.
  const Rgb dielectricGain = gain(m.dielectricF0), metalGain = gain(metalF0);
  f0_ = glm::mix(m.dielectricF0 * dielectricGain, metalF0 * metalGain, m.metallic);
  f90_ = glm::mix(m.dielectricF90 * dielectricGain, metalGain, m.metallic);

  const float dielectricF0 = maxComponent(m.dielectricF0);
  surfaceAlbedo_ = (dielectricF0 * once.a + m.dielectricF90 * once.b) * gain(dielectricF0);
  diffuse_ = diffuse * (1 - surfaceAlbedo_);
  specularAlbedo_ = f0_ * once.a + f90_ * once.b;
  const float specular = luminance(specularAlbedo_);
  albedo_ = specular + luminance(diffuse_);
  specularProbability_ = albedo_ > 0 ? specular / albedo_ : 1;
}

Rgb Brushed::fresnel(float cosine) const {
  return fresnelSchlick(f0_, f90_, std::min(cosine, 1.0f));
}

BsdfValue Brushed::evaluate(const vec3& wi, Lobes lobes) const {
  const vec3 local = frame_.toLocal(wi);
  if (local.z <= 0 || glm::dot(geometricNormal_, wi) <= 0) return {Rgb(0), 0};
  BsdfValue v{Rgb(0), 0};
  if (lobes == Lobes::Broad)
    v = {diffuse_ * (local.z * kInvPi), (1 - specularProbability_) * local.z * kInvPi};
  if (narrow_ != (lobes == Lobes::Narrow)) return v;
  const vec3 h = glm::normalize(wo_ + local);
  const float d = ggx::distribution(h, alpha_) / (4 * wo_.z);
  v.fCos += fresnel(glm::dot(wo_, h)) * (d / (1 + lambdaO_ + ggx::lambda(local, alpha_)));
  v.pdf += specularProbability_ * d / (1 + lambdaO_);
  return v;
}

bool Brushed::sample(vec2 u, float lobe, BsdfSample& out) const {
  out.lobes = Lobes::Broad;
  out.isDiffuse = !(lobe < specularProbability_);
  if (!out.isDiffuse) {
    if (narrow_) out.lobes = Lobes::Narrow;
    const vec3 h = ggx::sampleVisibleNormal(wo_, alpha_, u);
    const vec3 local = 2 * glm::dot(wo_, h) * h - wo_;
    out.wi = frame_.toWorld(local);
    if (local.z <= 0 || glm::dot(geometricNormal_, out.wi) <= 0) return false;
  } else {
    out.wi = frame_.toWorld(squareToCosineHemisphere(u));
  }
  return completeSample(evaluate(out.wi, out.lobes), out);
}

void Brushed::addTo(MapLobes& lobes, float weight) const {
  const vec3 mirrored(-wo_.x, -wo_.y, wo_.z);
  lobes.add({weight * specularAlbedo_, glm::normalize(frame_.toWorld(mirrored)), false,
             std::sqrt(std::sqrt(alpha_.x * alpha_.y))});
  if (!isBlack(diffuse_)) lobes.addDiffuse(weight * diffuse_, normal());
}

void Brushed::keepOnly(KeptLobes kept) {
  const float specular = specularProbability_ * albedo_;
  if (!kept.diffuse) {
    diffuse_ = Rgb(0);
    albedo_ = specular;
    specularProbability_ = 1;
  }
  if (!kept.specular) {
    f0_ = f90_ = specularAlbedo_ = Rgb(0);
    albedo_ -= specular;
    specularProbability_ = 0;
    narrow_ = false;
  }
}

}  // namespace chromeball
