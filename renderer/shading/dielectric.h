// SPDX-License-Identifier: Apache-2.0
// The smooth boundary between two dielectrics. `eta`: the index of refraction on the far side over
// the one on the near side, where the light is seen from.
#pragma once

#include "math/vec.h"

namespace chromeball {

// Share of unpolarised light that is reflected; 1 where it is reflected totally.
inline float fresnelDielectric(float cosine, float eta) {
  const float sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return 1;
  const float beyond = std::sqrt(1 - sin2);
  const float s = (cosine - eta * beyond) / (cosine + eta * beyond);
  const float p = (eta * cosine - beyond) / (eta * cosine + beyond);
  return 0.5f * (s * s + p * p);
}

// The direction in which light seen along wo (unit, wo.h > 0) is bent at a facet with normal h, by
// Snell's law. There must be one: no total reflection.
inline vec3 refracted(const vec3& wo, const vec3& h, float eta) {
  const float cosine = glm::dot(wo, h);
  const float beyond = std::sqrt(std::max(0.0f, 1 - (1 - cosine * cosine) / (eta * eta)));
  return -wo / eta + (cosine / eta - beyond) * h;
}

}  // namespace chromeball
