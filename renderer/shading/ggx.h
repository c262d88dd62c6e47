// SPDX-License-Identifier: Apache-2.0
// The GGX microfacet distribution (Walter et al. 2007, "Microfacet Models for Refraction through
// Rough Surfaces") in the frame of the normal, +z.
#pragma once

#include "math/warp.h"

namespace chromeball::ggx {

// D(h): pdf of microfacet normals per solid angle and projected area (Walter et al. 2007, eq. 33).
// `alpha` is the width, the square of glTF's perceptual roughness. This form of the equation is
// accurate for alpha down to 1e-4.
inline float distribution(const vec3& h, float alpha) {
  const float e = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
  return 1 / (kPi * alpha * alpha * e * e);
}

// Smith's Lambda for a direction w with w.z = z (Heitz 2014, "Understanding the Masking-Shadowing
// Function in Microfacet-Based BRDFs", eq. 72).
inline float lambda(float z, float alpha) {
  const float z2 = z * z;
  return 0.5f * (std::sqrt(1 + alpha * alpha * (1 - z2) / z2) - 1);
}
inline float lambda(const vec3& w, float alpha) { return lambda(w.z, alpha); }
// Height-correlated masking and shadowing of two directions (Heitz 2014, eq. 99), and of one.
inline float g2(float zo, float zi, float alpha) {
  return 1 / (1 + lambda(zo, alpha) + lambda(zi, alpha));
}
inline float g1(float z, float alpha) { return 1 / (1 + lambda(z, alpha)); }

// A normal visible from wo, with pdf G1(wo) D(h) max(0, wo.h) / wo.z over solid angle
// (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
inline vec3 sampleVisibleNormal(const vec3& wo, float alpha, vec2 u) {
  const vec3 stretched = glm::normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
  const float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  const vec3 h = unitVector(z, u.x) + stretched;
  return glm::normalize(vec3(alpha * h.x, alpha * h.y, std::max(0.0f, h.z)));
}

// Pdf over solid angle of the direction that mirrors wo about such a normal h.
inline float reflectedPdf(const vec3& wo, const vec3& h, float alpha) {
  return distribution(h, alpha) * g1(wo.z, alpha) / (4 * wo.z);
}

// Anisotropic: wider along the tangent, +x; stretched to a width for each of x and y (Heitz 2014,
// "stretch invariance").

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
