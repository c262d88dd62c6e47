// SPDX-License-Identifier: Apache-2.0
#include "transport/guided_lanes.h"

#include "transport/path_lanes.h"

namespace chromeball {
namespace {

using L = LanesOf<Float8>;
using Vector = Lanes3<Float8>;

vec3 laneOf(const Vector& v, unsigned lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }

}  // namespace

GuidedBsdfLanes::GuidedBsdfLanes(const PlainBsdfLanes& bsdf, const Vector& position,
                                 const Vector& wo, Int8 mayBeGuided, const CausticGuide* guide)
    : bsdf_(bsdf), position_(position) {
  if (!guide || guide->empty()) return;
  const Vector normal = bsdf.normal();
  forBits(bitsOf(mayBeGuided & bsdf.hasBroad()), [&](unsigned lane) {
    lobes_[lane] = guide->find(laneOf(position, lane), laneOf(normal, lane));
    isGuided_[lane] = lobes_[lane] ? -1 : 0;
  });
  if (bitsOf(isGuided_) == 0) return;
  const Vector mirrored = 2 * dot(wo, normal) * normal - wo;
  isGuided_ &= bsdf.evaluate(mirrored).pdf < kConcentratedPdf;
  guided_ = bitsOf(isGuided_);
  fraction_ = guide->fraction();
}

Float8 GuidedBsdfLanes::lobesPdf(const Vector& wi, unsigned bits) const {
  Float8 pdf{};
  forBits(bits, [&](unsigned lane) {
    pdf[lane] = lobes_[lane]->pdf(laneOf(position_, lane), laneOf(wi, lane));
  });
  return pdf;
}

// Only lanes that may be lit need the lobes' pdf.
BsdfLanesValue GuidedBsdfLanes::evaluateGuided(const Vector& wi) const {
  BsdfLanesValue value = bsdf_.evaluate(wi);
  const Int8 isMixed = isGuided_ & ~isBlack(value.fCos);
  const Float8 lobes = lobesPdf(wi, bitsOf(isMixed));
  value.pdf = isMixed ? mixed(value.pdf, lobes) : value.pdf;
  return value;
}

GuidedBsdfLanes::Bounce GuidedBsdfLanes::sample(Float8 u, Float8 v, Float8 lobe,
                                                Float8 choice) const {
  Bounce out{bsdf_.sample(u, v, lobe), {}, {}, L::splat(1)};
  out.bsdfPdf = out.pdf;
  if (guided_ != 0) sampleGuided(u, v, lobe, choice, out);
  return out;
}

void GuidedBsdfLanes::sampleGuided(Float8 u, Float8 v, Float8 lobe, Float8 choice,
                                   Bounce& out) const {
  const Int8 isChosen = isGuided_ & (choice < fraction_);  // from the lobes
  const Int8 isDelta = isGuided_ & ~isChosen & (out.bsdfPdf == 0);
  const Int8 isMixed = isGuided_ & ~isChosen & ~isDelta & out.isValid;
  out.lobesPdf = lobesPdf(out.wi, bitsOf(isMixed));
  forBits(bitsOf(isChosen), [&](unsigned lane) {
    const CausticLobes::Sample sample =
        lobes_[lane]->sample(laneOf(position_, lane), {u[lane], v[lane]}, lobe[lane]);
    out.wi.x[lane] = sample.direction.x;
    out.wi.y[lane] = sample.direction.y;
    out.wi.z[lane] = sample.direction.z;
    out.lobesPdf[lane] = sample.pdf;
  });
  const BsdfLanesValue value = bsdf_.evaluate(out.wi);
  out.bsdfPdf = isChosen ? value.pdf : out.bsdfPdf;
  out.pdf = isChosen | isMixed ? mixed(out.bsdfPdf, out.lobesPdf) : out.pdf;
  const Int8 hasRatio = (isChosen | isMixed) & (out.bsdfPdf > 0);
  out.ratio = hasRatio ? out.pdf / out.bsdfPdf : isDelta ? L::splat(1 - fraction_) : out.ratio;
  const Vector weight = (1 / out.ratio) * out.weight;
  out.weight =
      chosen(isChosen, (1 / out.pdf) * value.fCos, chosen(isMixed | isDelta, weight, out.weight));
  out.isValid = isChosen ? ~isBlack(value.fCos) & ~(out.pdf <= 0) : out.isValid;
}

}  // namespace chromeball
