// SPDX-License-Identifier: Apache-2.0
#include "shading/anisotropic_table.h"

#include "base/parallel.h"
#include "shading/albedo_quadrature.h"

namespace chromeball {
namespace {

// Node i of `count` as a fraction of the way from the first to the last.
float fraction(int i, int count) { return float(i) / float(count - 1); }

}  // namespace

// Roughness and angle go as t^2, as in albedo_quadrature.h; symmetry leaves a quarter of a turn.
AnisotropicTable::AnisotropicTable() {
  const std::vector<vec2> points = quadraturePoints(512);
  parallelFor(0, kRoughnesses * kStrengths, [&](int row) {
    const int r = row / kStrengths, s = row % kStrengths;
    const float t = fraction(r, kRoughnesses);
    const vec2 alpha = ggx::anisotropicAlpha(t * t, fraction(s, kStrengths));
    for (int i = 0; i < kAngles; ++i)
      for (int j = 0; j < kAzimuths; ++j) {
        const vec3 wo = unitVector(angleNode(i, kAngles), 0.25f * fraction(j, kAzimuths));
        grid_.node({r, s, i, j}) = specularAlbedo(wo, alpha, points);
      }
  });
}

SpecularAlbedo AnisotropicTable::albedo(const vec3& wo, float roughness, float strength) const {
  const float turns = atan2Turns(std::fabs(wo.y), std::fabs(wo.x));
  SpecularAlbedo sum{0, 0};
  grid_.forCorners(
      {GridPosition(std::sqrt(roughness), kRoughnesses), GridPosition(strength, kStrengths),
       GridPosition(std::sqrt(wo.z), kAngles), GridPosition(4 * turns, kAzimuths)},
      [&](const SpecularAlbedo& value, float weight) {
        sum.a += weight * value.a;
        sum.b += weight * value.b;
      });
  return sum;
}

}  // namespace chromeball
