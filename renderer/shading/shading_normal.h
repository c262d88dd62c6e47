// SPDX-License-Identifier: Apache-2.0
// Shading normals that are consistent with the geometry.
#pragma once

#include "math/vec.h"

namespace chromeball {

// Turns the shading normal towards the geometric one as far as needed for the mirror direction of
// wo to leave the surface: smooth normals on coarse meshes would otherwise leave black rims (Keller
// et al. 2017, "The Iray Light Transport Simulation and Rendering System").
inline vec3 normalThatReflects(const vec3& normal, const vec3& geometricNormal, const vec3& wo) {
  const vec3 mirrored = 2 * glm::dot(normal, wo) * normal - wo;
  const float height = glm::dot(mirrored, geometricNormal);
  const float minimum = 0.1f * std::min(glm::dot(wo, geometricNormal), 1.0f);
  if (height >= minimum) return normal;
  const vec3 lifted = glm::normalize(mirrored + (minimum - height) * geometricNormal);
  return glm::normalize(lifted + wo);
}

}  // namespace chromeball
