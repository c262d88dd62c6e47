// SPDX-License-Identifier: Apache-2.0
#include "shading/energy_table.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr float kMirrorAlpha = 1.001e-4f;  // ggx::kSmoothAlpha, the smallest node, with a margin

// The smoothest surfaces are perfect mirrors, without masking even at grazing angles.
SpecularAlbedo mirrorAlbedo(float mu) {
  const float c = 1 - mu, grazing = c * c * c * c * c;
  return {1 - grazing, grazing};
}

// 2 int E(mu) mu dmu of the piecewise linear interpolant, so that the compensation conserves energy
// exactly.
template <int kAngles>
SpecularAlbedo average(const GridTable<SpecularAlbedo, kAngles>& line) {
  constexpr int kSteps = 4096;
  double a = 0, b = 0;
  for (int k = 0; k < kSteps; ++k) {
    const float mu = (float(k) + 0.5f) / kSteps;
    const SpecularAlbedo albedo = line.interpolate({GridPosition(std::sqrt(mu), kAngles)});
    a += 2.0 * mu * albedo.a / kSteps;
    b += 2.0 * mu * albedo.b / kSteps;
  }
  return {float(a), float(b)};
}

}  // namespace

EnergyTable::EnergyTable() {
  const std::vector<vec2> points = quadraturePoints(4096);
  parallelFor(0, kRoughnesses, [&](int r) {
    const float roughness = roughnessNode(r, kRoughnesses), alpha = roughness * roughness;
    GridTable<SpecularAlbedo, kAngles> line;
    for (int i = 0; i < kAngles; ++i) {
      const float mu = angleNode(i, kAngles);
      const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
      grid_.node({r, i}) = line.node({i}) =
          alpha <= kMirrorAlpha ? mirrorAlbedo(mu) : specularAlbedo(wo, alpha, points);
    }
    averages_.node({r}) = average(line);
  });
}

EnergyTable::Row EnergyTable::row(float roughness) const {
  const GridPosition position(std::sqrt(roughness), kRoughnesses);
  return Row(grid_, position, averages_.interpolate({position}));
}

SpecularAlbedo EnergyTable::Row::at(float mu) const {
  return grid_->interpolate({roughness_, GridPosition(std::sqrt(mu), kAngles)});
}

namespace {

// Node i of `count` as a fraction of the way from the first to the last.
float fraction(int i, int count) { return float(i) / float(count - 1); }

}  // namespace

// Roughness and angle go as t^2, as in energy_table.h; symmetry leaves a quarter of a turn.
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
