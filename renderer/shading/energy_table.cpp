// SPDX-License-Identifier: Apache-2.0
#include "shading/energy_table.h"

#include "base/parallel.h"
#include "shading/albedo_quadrature.h"

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

}  // namespace chromeball
