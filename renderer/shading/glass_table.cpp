#include "shading/glass_table.h"

#include <tbb/parallel_for.h>

#include "shading/albedo_quadrature.h"
#include "shading/dielectric.h"

namespace chromeball {
namespace {

constexpr int kEtas = 33, kRoughnesses = 16, kAngles = 32;

// (eta - 1) / (eta + 1) from -1/2 to 1/2, crowded about 0, where facets cease to bend light; the
// other two as in albedo_quadrature.h.
constexpr float kLargest = 0.5f;
float etaNode(int i) {
  const float t = 2 * float(i) / (kEtas - 1) - 1, x = kLargest * t * std::fabs(t);
  return (1 + x) / (1 - x);
}
float etaCoordinate(float eta) {
  const float x = (eta - 1) / ((eta + 1) * kLargest);
  return 0.5f + 0.5f * std::copysign(std::sqrt(std::fabs(x)), x);
}

// The mean over visible normals of G2/G1, reflected and refracted by Fresnel's shares.
float integrate(float mu, float alpha, float eta, std::span<const vec2> points) {
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  const float masked = ggx::g1(mu, alpha);
  double sum = 0;
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h), reflectance = fresnelDielectric(woH, eta);
    const float up = 2 * woH * h.z - mu;
    if (up > 0) sum += double(reflectance * ggx::g2(mu, up, alpha) / masked);
    if (reflectance >= 1) continue;
    const float down = -refracted(wo, h, eta).z;
    if (down > 0) sum += double((1 - reflectance) * ggx::g2(mu, down, alpha) / masked);
  }
  return float(sum / double(points.size()));
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
  const std::vector<vec2> points = quadraturePoints(512);
  tbb::parallel_for(0, kEtas * kRoughnesses, [&](int row) {
    const float roughness = roughnessNode(row % kRoughnesses, kRoughnesses);
    for (int i = 0; i < kAngles; ++i)
      cells_[size_t(row * kAngles + i)] = integrate(angleNode(i, kAngles), roughness * roughness,
                                                    etaNode(row / kRoughnesses), points);
  });
}

const GlassTable& GlassTable::get() {
  static const GlassTable table;
  return table;
}

float GlassTable::albedo(float mu, float roughness, float eta) const {
  const Place e(etaCoordinate(eta), kEtas);
  const Place r(std::sqrt(roughness), kRoughnesses), a(std::sqrt(mu), kAngles);
  const auto line = [&](int eIndex, int rIndex) {
    const float* cell = &cells_[size_t((eIndex * kRoughnesses + rIndex) * kAngles + a.low)];
    return cell[0] + a.blend * (cell[1] - cell[0]);
  };
  const auto plane = [&](int eIndex) {
    const float low = line(eIndex, r.low);
    return low + r.blend * (line(eIndex, r.low + 1) - low);
  };
  const float low = plane(e.low);
  return low + e.blend * (plane(e.low + 1) - low);
}

}  // namespace chromeball
