// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf_tables.h"

#include <algorithm>
#include <mutex>
#include <type_traits>

#include "base/parallel.h"
#include "math/warp.h"
#include "shading/fresnel.h"
#include "shading/sheen.h"

namespace chromeball {
namespace {

constexpr float kMirrorAlpha = 1.001e-4f;  // kSmoothAlpha, the smallest node, with a margin

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

// Roughness and angle go as t^2, as in bsdf_tables.h; symmetry leaves a quarter of a turn.
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

namespace {

// x = (eta - 1) / (eta + 1) from -1/2 to 1/2, with dense nodes about 0, where refraction vanishes
// and the critical angle approaches 90 degrees. Roughness and angle are as in bsdf_tables.h.
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

namespace {

// Textures scale the factors of a material by at most 1, so a factor of 0 stays 0.
bool needsEnergy(const Material& m) { return m.metallic > 0 || m.specular > 0 || m.extended; }
bool needsAnisotropic(const Material& m) { return m.extended && m.extended->anisotropy > 0; }
bool needsSheen(const Material& m) { return m.extended && !isBlack(m.extended->sheenColor); }
bool needsGlass(const Material& m) { return m.isBody() && m.roughness > 0; }
bool isBody(const Material& m) { return m.isBody(); }

// A constant, of which the process has one copy from its first use on. It is made without the lock,
// for which no loop of another thread shall wait: of two threads that come at once, both make it.
template <class Table>
std::shared_ptr<const Table> constantTable() {
  static std::mutex holding;
  static std::shared_ptr<const Table> constant;
  {
    const std::scoped_lock lock(holding);
    if (constant) return constant;
  }
  auto made = std::make_shared<const Table>();
  const std::scoped_lock lock(holding);
  if (!constant) constant = std::move(made);
  return constant;
}

}  // namespace

BsdfTables::BsdfTables(std::span<const Material> materials, bool widened) {
  complete(materials, widened);
}

void BsdfTables::complete(std::span<const Material> materials, bool widened) {
  const auto make = [&](auto& table, bool (*needs)(const Material&)) {
    using Table =
        std::remove_const_t<typename std::remove_reference_t<decltype(table)>::element_type>;
    if (!table && std::ranges::any_of(materials, needs)) table = constantTable<Table>();
  };
  make(energy, needsEnergy);
  make(anisotropic, needsAnisotropic);
  make(sheen, needsSheen);
  make(glass, widened ? isBody : needsGlass);
}

}  // namespace chromeball
