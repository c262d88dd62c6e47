// SPDX-License-Identifier: Apache-2.0
#include "transport/guided_bsdf.h"

namespace chromeball {

GuidedBsdf::GuidedBsdf(const Bsdf& bsdf, const vec3& position, const vec3& wo,
                       const CausticGuide* guide)
    : bsdf_(bsdf), position_(position) {
  if (!guide || guide->empty() || !bsdf.has(Lobes::Broad)) return;
  const CausticLobes* lobes = guide->find(position, bsdf.normal());
  if (!lobes) return;
  const vec3 mirrored = 2 * glm::dot(wo, bsdf.normal()) * bsdf.normal() - wo;
  if (!(bsdf.evaluate(mirrored).pdf < kConcentratedPdf)) return;
  if (bsdf.transmits() && !(bsdf.evaluate(-wo).pdf < kConcentratedPdf)) return;
  lobes_ = lobes;
  fraction_ = guide->fraction();
}

bool GuidedBsdf::sampleLobes(const PixelSampler& sampler, Bounce& out) const {
  const CausticLobes::Sample chosen =
      lobes_->sample(position_, sampler.get2(dimension::kBsdf), sampler.get1(dimension::kLobe));
  const BsdfValue value = bsdf_.evaluate(chosen.direction);
  if (isBlack(value.fCos)) return false;
  out.wi = chosen.direction;
  out.lobes = Lobes::Broad;
  out.bsdfPdf = value.pdf;
  out.lobesPdf = chosen.pdf;
  out.fraction = fraction_;
  if (value.pdf > 0) out.ratio = mixed(value.pdf, chosen.pdf) / value.pdf;
  return completeSample({value.fCos, mixed(value.pdf, chosen.pdf)}, out);
}

bool GuidedBsdf::sample(const PixelSampler& sampler, Bounce& out) const {
  if (lobes_ && sampler.get1(dimension::kBounce) < fraction_) return sampleLobes(sampler, out);
  if (!bsdf_.sample(sampler.get2(dimension::kBsdf), sampler.get1(dimension::kLobe), out))
    return false;
  out.bsdfPdf = out.pdf;
  if (!lobes_) return true;
  if (out.isDelta || out.lobes == Lobes::Narrow) {
    out.ratio = 1 - fraction_;
    out.weight /= out.ratio;
    return true;
  }
  out.lobesPdf = lobes_->pdf(position_, out.wi);
  out.fraction = fraction_;
  out.pdf = mixed(out.bsdfPdf, out.lobesPdf);
  out.ratio = out.pdf / out.bsdfPdf;
  out.weight *= out.bsdfPdf / out.pdf;
  return true;
}

}  // namespace chromeball
