// SPDX-License-Identifier: Apache-2.0
#include "shading/energy_table.h"

#include <tbb/parallel_for.h>

#include "shading/albedo_quadrature.h"

namespace chromeball {
namespace {

constexpr int kRoughnesses = 32, kAngles = 64;
constexpr float kMirrorAlpha = 1.001e-4f;  // bsdf.cpp's kSmoothAlpha, and the least node squared

// The smoothest surfaces are mirrors (bsdf.cpp), whose facets mask nothing even at grazing angles.
SpecularAlbedo mirrorAlbedo(float mu) {
  const float c = 1 - mu, grazing = c * c * c * c * c;
  return {1 - grazing, grazing};
}

SpecularAlbedo mix(const SpecularAlbedo& x, const SpecularAlbedo& y, float t) {
  return {x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
}

}  // namespace

EnergyTable::EnergyTable() : cells_(kRoughnesses * kAngles), averages_(kRoughnesses) {
  const std::vector<vec2> points = quadraturePoints(4096);
  tbb::parallel_for(0, kRoughnesses, [&](int r) {
    const float roughness = roughnessNode(r, kRoughnesses), alpha = roughness * roughness;
    for (int i = 0; i < kAngles; ++i) {
      const float mu = angleNode(i, kAngles);
      const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
      cells_[r * kAngles + i] =
          alpha <= kMirrorAlpha ? mirrorAlbedo(mu) : specularAlbedo(wo, alpha, points);
    }
    // The average of the very interpolant that at() returns, so that compensation balances.
    constexpr int kSteps = 4096;
    Row row;
    row.low_ = row.high_ = &cells_[r * kAngles];
    row.blend_ = 0;
    double a = 0, b = 0;
    for (int k = 0; k < kSteps; ++k) {
      const float mu = (float(k) + 0.5f) / kSteps;
      a += 2.0 * mu * row.at(mu).a / kSteps;
      b += 2.0 * mu * row.at(mu).b / kSteps;
    }
    averages_[r] = {float(a), float(b)};
  });
}

const EnergyTable& EnergyTable::get() {
  static const EnergyTable table;
  return table;
}

EnergyTable::Row EnergyTable::row(float roughness) const {
  const float x = std::sqrt(roughness) * (kRoughnesses - 1);
  const int i = std::min(int(x), kRoughnesses - 2);
  Row row;
  row.low_ = &cells_[i * kAngles];
  row.high_ = row.low_ + kAngles;
  row.blend_ = x - float(i);
  row.average_ = mix(averages_[i], averages_[i + 1], row.blend_);
  return row;
}

SpecularAlbedo EnergyTable::Row::at(float mu) const {
  const float x = std::sqrt(mu) * (kAngles - 1);
  const int i = std::min(int(x), kAngles - 2);
  const float t = x - float(i);
  return mix(mix(low_[i], low_[i + 1], t), mix(high_[i], high_[i + 1], t), blend_);
}

}  // namespace chromeball
