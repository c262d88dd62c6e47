// SPDX-License-Identifier: Apache-2.0
// Weights of samples of light and of the BSDF (multiple importance sampling, Veach 1997, 9.2).
#pragma once

#include "lighting/strategy.h"

namespace chromeball {

// Weight of a sample with pdf `own` (> 0) that the other technique finds with pdf `other`; both of
// one measure.
inline float misWeight(Mis mis, float own, float other) {
  const float ratio = other / own;
  return 1 / (1 + (mis == Mis::Power ? ratio * ratio : ratio));
}

// Weight of light found by a BSDF sample that is no delta. With MIS off, light samples take all
// that they can find.
inline float bsdfSampleWeight(Mis mis, float bsdfPdf, float lightPdf) {
  if (lightPdf == 0) return 1;
  return mis == Mis::Off ? 0 : misWeight(mis, bsdfPdf, lightPdf);
}

// Weight of a light sample that is no delta light.
inline float lightSampleWeight(Mis mis, float lightPdf, float bsdfPdf) {
  return mis == Mis::Off ? 1 : misWeight(mis, lightPdf, bsdfPdf);
}

}  // namespace chromeball
