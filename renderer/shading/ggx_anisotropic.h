// SPDX-License-Identifier: Apache-2.0
// Anisotropic GGX, wider along the tangent, +x: as ggx.h, stretched to a width for each of x and y
// (Heitz 2014, "stretch invariance").
#pragma once

#include "math/warp.h"

namespace chromeball::ggx {

// Widths along and across the tangent, for perceptual roughness and strength in [0, 1]
// (KHR_materials_anisotropy, "Implementation").
inline vec2 anisotropicAlpha(float roughness, float strength) {
  constexpr float kMin = 1e-3f;  // narrower lobes look the same, a thin line
  const float alpha = std::max(roughness * roughness, kMin);
  return {glm::mix(alpha, 1.0f, strength * strength), alpha};
}

inline float distribution(const vec3& h, vec2 alpha) {
  const float x = h.x / alpha.x, y = h.y / alpha.y, e = x * x + y * y + h.z * h.z;
  return 1 / (kPi * alpha.x * alpha.y * e * e);
}

inline float lambda(const vec3& w, vec2 alpha) {
  const float x = alpha.x * w.x, y = alpha.y * w.y;
  return 0.5f * (std::sqrt(1 + (x * x + y * y) / (w.z * w.z)) - 1);
}

inline vec3 sampleVisibleNormal(const vec3& wo, vec2 alpha, vec2 u) {
  const vec3 stretched = glm::normalize(vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z));
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const vec3 h = unitVector(z, u.x) + stretched;
  return glm::normalize(vec3(alpha.x * h.x, alpha.y * h.y, std::max(0.0f, h.z)));
}

}  // namespace chromeball::ggx
