// SPDX-License-Identifier: Apache-2.0
// Guided bounces of paths in lanes. GuidedBsdf, for one point, is the reference.
#pragma once

#include <array>

#include "guiding/caustic_guide.h"
#include "shading/bsdf_lanes.h"

namespace chromeball {

// GuidedBsdf at eight points. A lane's results do not depend on the other lanes.
class GuidedBsdfLanes {
 public:
  // `mayBeGuided`: the lanes that the guide may take part in. `guide` may be null; it and the BSDF
  // must outlive this.
  GuidedBsdfLanes(const PlainBsdfLanes& bsdf, const Lanes3<Float8>& position,
                  const Lanes3<Float8>& wo, Int8 mayBeGuided, const CausticGuide* guide);

  BsdfLanesValue evaluate(const Lanes3<Float8>& wi) const {
    return guided_ == 0 ? bsdf_.evaluate(wi) : evaluateGuided(wi);
  }

  // As GuidedBsdf::Bounce.
  struct Bounce : BsdfLanesSample {
    Float8 bsdfPdf, lobesPdf, ratio;
  };
  // `choice`, in [0, 1), chooses between the guide and the BSDF.
  Bounce sample(Float8 u, Float8 v, Float8 lobe, Float8 choice) const;

  bool isGuided() const { return guided_ != 0; }  // in any lane
  float fraction() const { return fraction_; }    // of guided bounces

 private:
  BsdfLanesValue evaluateGuided(const Lanes3<Float8>& wi) const;
  void sampleGuided(Float8 u, Float8 v, Float8 lobe, Float8 choice, Bounce& out) const;
  // The lobes' pdf in the directions of the lanes of `bits`; 0 in the others.
  Float8 lobesPdf(const Lanes3<Float8>& wi, unsigned bits) const;
  Float8 mixed(Float8 bsdfPdf, Float8 lobesPdf) const {
    return fraction_ * lobesPdf + (1 - fraction_) * bsdfPdf;
  }

  const PlainBsdfLanes& bsdf_;
  const Lanes3<Float8>& position_;
  std::array<const CausticLobes*, LanesOf<Float8>::kCount> lobes_;  // of guided lanes
  Int8 isGuided_{};
  unsigned guided_ = 0;  // its bits
  float fraction_ = 0;
};

}  // namespace chromeball
