#include "shading/energy_table.h"

#include <tbb/parallel_for.h>

#include "math/hash.h"
#include "math/sobol.h"
#include "shading/ggx.h"

namespace chromeball {
namespace {

constexpr int kRoughnesses = 32, kAngles = 64;
constexpr float kMirrorAlpha = 1.001e-4f;  // bsdf.cpp's kSmoothAlpha, and the least node squared

// Nodes crowd towards smooth surfaces and grazing angles, where the albedo bends: both are t^2.
float roughnessNode(int i) {
  const float t = float(i) / (kRoughnesses - 1);
  return std::max(t * t, 0.01f);
}
float angleNode(int i) {
  const float t = float(i) / (kAngles - 1);
  return std::max(t * t, 1e-4f);
}

// Averages over visible normals h: albedo = E[F(wo.h) G2/G1]. The smoothest are mirrors (bsdf.cpp),
// whose facets mask nothing even at grazing angles.
SpecularAlbedo integrate(float mu, float alpha, const std::vector<vec2>& points) {
  if (alpha <= kMirrorAlpha) {
    const float c = 1 - mu, grazing = c * c * c * c * c;
    return {1 - grazing, grazing};
  }
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  double a = 0, b = 0;
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h);
    const vec3 wi = 2 * woH * h - wo;
    if (wi.z <= 0) continue;
    const float weight = ggx::g2(mu, wi.z, alpha) / ggx::g1(mu, alpha);
    const float c = 1 - woH, grazing = c * c * c * c * c;
    a += double(weight) * (1 - grazing);
    b += double(weight) * grazing;
  }
  return {float(a / double(points.size())), float(b / double(points.size()))};
}

SpecularAlbedo mix(const SpecularAlbedo& x, const SpecularAlbedo& y, float t) {
  return {x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
}

}  // namespace

EnergyTable::EnergyTable() : cells_(kRoughnesses * kAngles), averages_(kRoughnesses) {
  constexpr uint32_t kSamples = 4096;
  std::vector<vec2> points(kSamples);
  for (uint32_t i = 0; i < kSamples; ++i) points[i] = {toUnit(sobol(i, 0)), toUnit(sobol(i, 1))};
  tbb::parallel_for(0, kRoughnesses, [&](int r) {
    const float roughness = roughnessNode(r);
    for (int i = 0; i < kAngles; ++i)
      cells_[r * kAngles + i] = integrate(angleNode(i), roughness * roughness, points);
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
