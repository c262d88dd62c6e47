// SPDX-License-Identifier: Apache-2.0
#include "shading/glass_table.h"

#include "base/parallel.h"
#include "shading/energy_table.h"
#include "shading/fresnel.h"

namespace chromeball {
namespace {

// x = (eta - 1) / (eta + 1) from -1/2 to 1/2, with dense nodes about 0, where refraction vanishes
// and the critical angle approaches 90 degrees. Roughness and angle as in energy_table.h.
constexpr float kMaxX = 0.5f, kExponent = 2.5f;
float etaNode(int i, int count) {
  const float t = 2 * float(i) / float(count - 1) - 1;
  const float x = kMaxX * std::copysign(std::pow(std::fabs(t), kExponent), t);
  return (1 + x) / (1 - x);
}
float etaCoordinate(float eta) {
  const float x = (eta - 1) / ((eta + 1) * kMaxX);
  return 0.5f + 0.5f * std::copysign(std::pow(std::fabs(x), 1 / kExponent), x);
}

// For all nodes of eta, the means over visible normals of G2/G1 times:
//   plain: 1 for total internal reflection and for refraction
//   a: 1 for reflection, -1 for refraction, below the critical angle
//   b: as a, times Fresnel's reflectance
template <size_t kEtas>
std::array<GlassAlbedo, kEtas> integrateGlass(float mu, float alpha, std::span<const vec2> points) {
  std::array<float, kEtas> etas;
  for (size_t e = 0; e < kEtas; ++e) etas[e] = etaNode(int(e), int(kEtas));
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const float masked = ggx::g1(mu, alpha), fraction = 1 / (masked * float(points.size()));
  const auto passed = [&](float z) { return z > 0 ? fraction * ggx::g2(mu, z, alpha) : 0; };
  std::array<GlassAlbedo, kEtas> sums{};
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h), up = passed(2 * woH * h.z - mu);
    for (size_t e = 0; e < kEtas; ++e) {
      const float reflectance = fresnelDielectric(woH, etas[e]);
      if (reflectance >= 1) {
        sums[e].plain += up;
        continue;
      }
      const float down = passed(-refracted(wo, h, etas[e]).z);
      sums[e].plain += down;
      sums[e].a += up - down;
      sums[e].b += reflectance * (up - down);
    }
  }
  return sums;
}

}  // namespace

GlassTable::GlassTable() {
  const std::vector<vec2> points = quadraturePoints(1024);
  parallelFor(0, kRoughnesses * kAngles, [&](int location) {
    const int r = location / kAngles, i = location % kAngles;
    const float roughness = roughnessNode(r, kRoughnesses);
    const auto albedos =
        integrateGlass<kEtas>(angleNode(i, kAngles), roughness * roughness, points);
    for (int e = 0; e < kEtas; ++e) grid_.node({e, r, i}) = albedos[size_t(e)];
  });
}

GlassAlbedo GlassTable::albedo(float mu, float roughness, float eta) const {
  return grid_.interpolate({GridPosition(etaCoordinate(eta), kEtas),
                            GridPosition(std::sqrt(roughness), kRoughnesses),
                            GridPosition(std::sqrt(mu), kAngles)});
}

}  // namespace chromeball
