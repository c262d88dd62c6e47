// SPDX-License-Identifier: Apache-2.0
#include "shading/sheen.h"

#include <tbb/parallel_for.h>

#include "base/hash.h"
#include "math/sobol.h"
#include "math/warp.h"

namespace chromeball {
namespace {

constexpr int kRoughnesses = 24, kAngles = 32;
constexpr float kSmoothest = 0.1f;

float roughnessNode(int i) { return kSmoothest + (1 - kSmoothest) * float(i) / (kRoughnesses - 1); }
float angleNode(int i) {
  const float t = float(i) / (kAngles - 1);
  return std::max(t * t, 1e-4f);
}

// Pdf of fibres' normals: peaks at right angles to the surface's.
float distribution(float z, float alpha) {
  const float sine = std::sqrt(std::max(0.0f, 1 - z * z));
  return (2 + 1 / alpha) * std::pow(sine, 1 / alpha) * (0.5f * kInvPi);
}

// Estevez and Kulla's fit to Smith's Lambda for it (section 3). Rounding may leave z above 1.
float lambda(float z, float alpha) {
  const float t = (1 - alpha) * (1 - alpha);
  const auto between = [t](float rough, float smooth) { return rough + t * (smooth - rough); };
  const float a = between(21.5473f, 25.3245f), b = between(3.82987f, 3.32435f);
  const float c = between(0.19823f, 0.16801f), d = between(-1.97760f, -1.27393f);
  const float e = between(-4.32054f, -4.85967f);
  const auto fit = [&](float x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return z < 0.5f ? std::exp(fit(z)) : std::exp(2 * fit(0.5f) - fit(std::max(1 - z, 0.0f)));
}

// f cos of the white lobe.
float lobe(const vec3& wo, const vec3& wi, float alpha) {
  const vec3 h = glm::normalize(wo + wi);
  return distribution(h.z, alpha) / (4 * wo.z * (1 + lambda(wo.z, alpha) + lambda(wi.z, alpha)));
}

float integrate(float mu, float roughness) {
  constexpr uint32_t kSamples = 2048;
  const vec3 wo(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (uint32_t i = 0; i < kSamples; ++i) {
    const vec2 u(toUnit(sobol(i, 0)), toUnit(sobol(i, 1)));
    sum += double(lobe(wo, squareToUniformHemisphere(u), roughness * roughness));
  }
  return float(2 * kPiD * sum / kSamples);
}

}  // namespace

SheenTable::SheenTable() : cells_(kRoughnesses * kAngles) {
  tbb::parallel_for(0, kRoughnesses, [&](int r) {
    for (int i = 0; i < kAngles; ++i)
      cells_[size_t(r * kAngles + i)] = integrate(angleNode(i), roughnessNode(r));
  });
}

const SheenTable& SheenTable::get() {
  static const SheenTable table;
  return table;
}

float SheenTable::albedo(float mu, float roughness) const {
  const float x = (roughness - kSmoothest) / (1 - kSmoothest) * (kRoughnesses - 1);
  const float y = std::sqrt(mu) * (kAngles - 1);
  const int i = std::clamp(int(x), 0, kRoughnesses - 2), j = std::clamp(int(y), 0, kAngles - 2);
  const float s = x - float(i), t = y - float(j);
  const float* low = &cells_[size_t(i * kAngles + j)];
  const float* high = low + kAngles;
  return glm::mix(glm::mix(low[0], low[1], t), glm::mix(high[0], high[1], t), s);
}

Sheen::Sheen(const Rgb& color, float roughness, const Surface& surface, const vec3& wo)
    : frame_(surface.normal),
      geometricNormal_(surface.geometricNormal),
      wo_(frame_.toLocal(wo)),
      color_(color) {
  wo_.z = std::max(wo_.z, 1e-4f);
  const float r = std::max(roughness, kSmoothest);
  alpha_ = r * r;
  albedo_ = SheenTable::get().albedo(std::min(wo_.z, 1.0f), r);
  if (albedo_ > 1) {  // the fitted masking lets too much through at grazing angles
    color_ /= albedo_;
  }
}

Bsdf::Value Sheen::evaluate(const vec3& wi, Lobes lobes) const {
  const vec3 local = frame_.toLocal(wi);
  if (lobes == Lobes::Narrow || local.z <= 0 || glm::dot(geometricNormal_, wi) <= 0)
    return {Rgb(0), 0};
  return {color_ * lobe(wo_, local, alpha_), squareToUniformHemispherePdf(local)};
}

bool Sheen::sample(vec2 u, float, BsdfSample& out) const {
  out.lobes = Lobes::Broad;
  out.wi = frame_.toWorld(squareToUniformHemisphere(u));
  return completeSample(evaluate(out.wi), out);
}

}  // namespace chromeball
