// SPDX-License-Identifier: Apache-2.0
// Depth limits, MIS and visibility settings of paths.
#pragma once

#include <algorithm>
#include <climits>
#include <cmath>
#include <numbers>

#include "guiding/caustic_guide.h"
#include "guiding/light_guide.h"
#include "lighting/strategy.h"
#include "scene/surface.h"
#include "trace/ray.h"

namespace chromeball {

// Enough for paths through several glass vessels in a row.
inline constexpr int kDefaultTransmissionDepth = 64;

struct PathSettings {
  Mis mis = Mis::Balance;
  int maxDepth = 8;  // 0: emission seen by the camera; 1: direct light; ...
  int maxTransmissionDepth =
      kDefaultTransmissionDepth;  // bounces in solid glass; not counted in maxDepth
  // Limits of the bounces in which a diffuse or a specular lobe chose the direction; transmission
  // in and on bodies of glass is neither.
  int maxDiffuseDepth = INT_MAX, maxSpecularDepth = INT_MAX;
  bool hideProbe = false;        // from the camera
  bool estimateDepthCut = true;  // estimate the light beyond the depth limits
  // A guide for strategies that can be guided (LightSource::canBeGuided()); null: none.
  const LightGuide* guide = nullptr;
  const CausticGuide* caustics = nullptr;  // likewise, for bounces
  RayMask visible = kAllInstances;         // all rays of the paths ignore other instances
  // If it differs from `visible`, shadow rays are traced with both masks, and
  // PathContext::shadowsDiffer is set if their transmittances differ.
  RayMask compared = visible;

  // Beyond maxDepth, which counts bounces of both kinds, they limit nothing.
  bool limitsKinds() const { return maxDiffuseDepth < maxDepth || maxSpecularDepth < maxDepth; }
};

// MIS weights of light samples and BSDF samples (Veach 1997, section 9.2).

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

// Path-space regularisation (Kaplanyan and Dachsbacher 2013, "Path space regularization for
// holistic and robust light transport"): biased, with a bias that vanishes with the samples.

// Behind a bounce that spreads light, surfaces are at least as rough as a fraction of that spread,
// so that light samples find the paths that end in a mirror or pass glass. The fraction for a
// pixel's sample with this index: the width of a two-dimensional kernel with the best ratio of
// squared bias, width^4, to variance, 1 / (samples width^2), falls with samples^(-1/6).
inline float regularizationWidth(uint32_t sample) {
  constexpr float kFirst = 0.5f;
  return kFirst * std::pow(float(sample) + 1, -1.0f / 6);
}

// The spread of a bounce, by the pdf of its direction over solid angle: 1 for a diffuse bounce,
// about twice its alpha for a GGX lobe.
inline float spreadOf(float pdf) {
  return std::min(1.0f, 1 / std::sqrt(std::numbers::pi_v<float> * pdf));
}

// Raises the roughness so that alpha, its square, is at least `minAlpha`.
inline void widen(MaterialPoint& material, float minAlpha) {
  material.roughness = std::max(material.roughness, std::sqrt(minAlpha));
}

}  // namespace chromeball
