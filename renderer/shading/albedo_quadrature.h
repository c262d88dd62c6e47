// SPDX-License-Identifier: Apache-2.0
// Common parts of the albedo tables: the positions of their nodes, and the integral at a node.
#pragma once

#include <span>
#include <vector>

#include "base/hash.h"
#include "math/sobol.h"
#include "shading/ggx.h"
#include "shading/ggx_anisotropic.h"
#include "shading/specular_albedo.h"

namespace chromeball {

// Perceptual roughness and cosine of the viewing angle at node i of `count`. Both go as t^2, so
// that the nodes are dense at smooth surfaces and grazing angles, where the albedo is curved.
inline float roughnessNode(int i, int count) {
  const float t = float(i) / float(count - 1);
  return std::max(t * t, 0.01f);
}
inline float angleNode(int i, int count) {
  const float t = float(i) / float(count - 1);
  return std::max(t * t, 1e-4f);
}

inline std::vector<vec2> quadraturePoints(uint32_t count) {
  std::vector<vec2> points(count);
  for (uint32_t i = 0; i < count; ++i) points[i] = {toUnit(sobol(i, 0)), toUnit(sobol(i, 1))};
  return points;
}

// The mean over visible normals h of F(wo.h) G2/G1 (Heitz 2018, "Sampling the GGX Distribution of
// Visible Normals", eq. 19). `Alpha`: float, or vec2 for anisotropic GGX.
template <class Alpha>
SpecularAlbedo specularAlbedo(const vec3& wo, const Alpha& alpha, std::span<const vec2> points) {
  const float lambdaO = ggx::lambda(wo, alpha);
  double a = 0, b = 0;
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h);
    const vec3 wi = 2 * woH * h - wo;
    if (wi.z <= 0) continue;
    const float weight = (1 + lambdaO) / (1 + lambdaO + ggx::lambda(wi, alpha));
    const float c = 1 - woH, grazing = c * c * c * c * c;
    a += double(weight) * (1 - grazing);
    b += double(weight) * grazing;
  }
  return {float(a / double(points.size())), float(b / double(points.size()))};
}

}  // namespace chromeball
