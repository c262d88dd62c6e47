// SPDX-License-Identifier: Apache-2.0
// MIS weights of light samples and BSDF samples (Veach 1997, section 9.2).
#pragma once

#include "lighting/strategy.h"

namespace chromeball {

// Weight of a sample with pdf `own` (> 0) whose pdf under the other technique is `other`; both
// over the same measure.
inline float misWeight(Mis mis, float own, float other) {
  const float ratio = other / own;
  return 1 / (1 + (mis == Mis::Power ? ratio * ratio : ratio));
}

// Weight of light found by a BSDF sample from a non-delta lobe. With MIS off it is 0 wherever light
// sampling has a nonzero pdf.
inline float bsdfSampleWeight(Mis mis, float bsdfPdf, float lightPdf) {
  if (lightPdf == 0) return 1;
  return mis == Mis::Off ? 0 : misWeight(mis, bsdfPdf, lightPdf);
}

// Weight of a sample of a non-delta light.
inline float lightSampleWeight(Mis mis, float lightPdf, float bsdfPdf) {
  return mis == Mis::Off ? 1 : misWeight(mis, lightPdf, bsdfPdf);
}

}  // namespace chromeball
