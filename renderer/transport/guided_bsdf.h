// SPDX-License-Identifier: Apache-2.0
// A BSDF some of whose bounces follow a guide.
#pragma once

#include "guiding/caustic_guide.h"
#include "math/sampler.h"
#include "shading/bsdf.h"

namespace chromeball {

// Each bounce that the guide does not choose has 1 / (1 - fraction) of the BSDF's weight: on long
// paths the product would grow without bound, and the variance with it. So a path has no guide once
// its pdf / BSDF pdf (PathState::guideRatio) is below the first; the second avoids overflow.
inline constexpr float kLeastGuideRatio = 1.0f / 8, kLargestGuideRatio = 1e20f;

// Broad bounces are drawn from a mixture of the BSDF and the guide's lobes at the position
// (one-sample model; Veach 1997, section 9.2.4). Narrow and delta lobes are not guided, nor are
// BSDFs with a pdf above kConcentratedPdf in the mirror direction or straight behind the surface:
// they find their light.
class GuidedBsdf {
 public:
  // `guide` may be null. `wo`: unit, towards the viewer. The BSDF must outlive this.
  GuidedBsdf(const Bsdf& bsdf, const vec3& position, const vec3& wo, const CausticGuide* guide);

  // The same guide for a copy of the BSDF.
  GuidedBsdf(const GuidedBsdf& other, const Bsdf& bsdf, const vec3& position)
      : bsdf_(bsdf), position_(position), lobes_(other.lobes_), fraction_(other.fraction_) {}

  const Bsdf& bsdf() const { return bsdf_; }

  // The value of the broad lobes, with the pdf of the mixture.
  BsdfValue evaluate(const vec3& wi) const {
    BsdfValue value = bsdf_.evaluate(wi);
    if (lobes_) value.pdf = mixed(value.pdf, lobes_->pdf(position_, wi));
    return value;
  }

  struct Bounce : BsdfSample {
    float bsdfPdf = 0;   // without the guide; 0 for a delta
    float lobesPdf = 0;  // 0 where the bounce is not guided
    float fraction = 0;  // of guided bounces
    float ratio = 1;     // pdf / BSDF pdf, also of a delta: the guide divides the weight by it
  };
  // False if the light is absorbed.
  bool sample(const PixelSampler& sampler, Bounce& out) const;

 private:
  float mixed(float bsdfPdf, float lobesPdf) const {
    return fraction_ * lobesPdf + (1 - fraction_) * bsdfPdf;
  }
  bool sampleLobes(const PixelSampler& sampler, Bounce& out) const;

  const Bsdf& bsdf_;
  const vec3& position_;
  const CausticLobes* lobes_ = nullptr;  // null: not guided
  float fraction_ = 0;                   // of bounces from the lobes
};

}  // namespace chromeball
