// SPDX-License-Identifier: Apache-2.0
#include "shading/sheen_table.h"

#include "base/parallel.h"
#include "math/warp.h"
#include "shading/charlie.h"
#include "shading/energy_table.h"

namespace chromeball {
namespace {

using charlie::kMinRoughness;

float integrateSheen(float mu, float alpha, std::span<const vec2> points) {
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (const vec2& u : points)
    sum += double(charlie::fCos(wo, squareToUniformHemisphere(u), alpha));
  return float(2 * kPiD * sum / double(points.size()));
}

}  // namespace

SheenTable::SheenTable() {
  const std::vector<vec2> points = quadraturePoints(2048);
  parallelFor(0, kRoughnesses, [&](int r) {
    const float roughness = kMinRoughness + (1 - kMinRoughness) * float(r) / (kRoughnesses - 1);
    for (int i = 0; i < kAngles; ++i)
      grid_.node({r, i}) = integrateSheen(angleNode(i, kAngles), roughness * roughness, points);
  });
}

float SheenTable::albedo(float mu, float roughness) const {
  return grid_.interpolate(
      {GridPosition((roughness - kMinRoughness) / (1 - kMinRoughness), kRoughnesses),
       GridPosition(std::sqrt(mu), kAngles)});
}

}  // namespace chromeball
