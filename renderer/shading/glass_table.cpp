// SPDX-License-Identifier: Apache-2.0
#include "shading/glass_table.h"

#include <tbb/parallel_for.h>

#include <array>

#include "shading/albedo_quadrature.h"
#include "shading/dielectric.h"

namespace chromeball {
namespace {

constexpr int kEtas = 49, kRoughnesses = 20, kAngles = 40;

// (eta - 1) / (eta + 1) from -1/2 to 1/2, crowded about 0, where facets cease to bend light and
// the critical angle runs towards the grazing one; the other two as in albedo_quadrature.h.
constexpr float kLargest = 0.5f, kCrowding = 2.5f;
float etaNode(int i) {
  const float t = 2 * float(i) / (kEtas - 1) - 1;
  const float x = kLargest * std::copysign(std::pow(std::fabs(t), kCrowding), t);
  return (1 + x) / (1 - x);
}
float etaCoordinate(float eta) {
  const float x = (eta - 1) / ((eta + 1) * kLargest);
  return 0.5f + 0.5f * std::copysign(std::pow(std::fabs(x), 1 / kCrowding), x);
}

// For all nodes of eta, the means over visible normals of G2/G1: of what facets reflect totally and
// refract wholly, of what reflection has more than refraction, and of that times Fresnel's
// reflectance.
std::array<GlassAlbedo, kEtas> integrate(float mu, float alpha, std::span<const vec2> points) {
  std::array<float, kEtas> etas;
  for (int e = 0; e < kEtas; ++e) etas[e] = etaNode(e);
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const float masked = ggx::g1(mu, alpha), fraction = 1 / (masked * float(points.size()));
  const auto passed = [&](float z) { return z > 0 ? fraction * ggx::g2(mu, z, alpha) : 0; };
  std::array<GlassAlbedo, kEtas> sums{};
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h), up = passed(2 * woH * h.z - mu);
    for (int e = 0; e < kEtas; ++e) {
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

GlassAlbedo mix(const GlassAlbedo& low, const GlassAlbedo& high, float t) {
  return {glm::mix(low.plain, high.plain, t), glm::mix(low.a, high.a, t),
          glm::mix(low.b, high.b, t)};
}

// Where between which two nodes a coordinate in [0, 1] lies.
struct Place {
  int low;
  float blend;
  Place(float t, int nodes) {
    const float x = glm::clamp(t, 0.0f, 1.0f) * float(nodes - 1);
    low = std::min(int(x), nodes - 2);
    blend = x - float(low);
  }
};

}  // namespace

GlassTable::GlassTable() : cells_(kEtas * kRoughnesses * kAngles) {
  const std::vector<vec2> points = quadraturePoints(1024);
  tbb::parallel_for(0, kRoughnesses * kAngles, [&](int location) {
    const float roughness = roughnessNode(location / kAngles, kRoughnesses);
    const auto albedos =
        integrate(angleNode(location % kAngles, kAngles), roughness * roughness, points);
    for (int e = 0; e < kEtas; ++e)
      cells_[size_t(e * kRoughnesses * kAngles + location)] = albedos[e];
  });
}

const GlassTable& GlassTable::get() {
  static const GlassTable table;
  return table;
}

GlassAlbedo GlassTable::albedo(float mu, float roughness, float eta) const {
  const Place e(etaCoordinate(eta), kEtas);
  const Place r(std::sqrt(roughness), kRoughnesses), a(std::sqrt(mu), kAngles);
  const auto line = [&](int eIndex, int rIndex) {
    const GlassAlbedo* cell = &cells_[size_t((eIndex * kRoughnesses + rIndex) * kAngles + a.low)];
    return mix(cell[0], cell[1], a.blend);
  };
  const auto plane = [&](int eIndex) {
    return mix(line(eIndex, r.low), line(eIndex, r.low + 1), r.blend);
  };
  return mix(plane(e.low), plane(e.low + 1), e.blend);
}

}  // namespace chromeball
