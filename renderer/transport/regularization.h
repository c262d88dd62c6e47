// SPDX-License-Identifier: Apache-2.0
// Path-space regularisation (Kaplanyan and Dachsbacher 2013, "Path space regularization for
// holistic and robust light transport"): biased, with a bias that vanishes with the samples.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/surface.h"

namespace chromeball {

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
