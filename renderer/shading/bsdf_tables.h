// SPDX-License-Identifier: Apache-2.0
// The precomputed tables of the BSDFs of a scene.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/hash.h"
#include "math/grid_table.h"
#include "math/sampler.h"
#include "scene/material.h"
#include "shading/ggx.h"

namespace chromeball {

// Albedo of isotropic GGX reflection in one bounce, for energy compensation.

// Directional albedo of GGX microfacets in one bounce.

// Under Schlick's Fresnel term F0 + (F90 - F0)(1 - cos)^5 the albedo is linear in F0 and F90:
//   E(mu) = F0 a(mu) + F90 b(mu),   mu the cosine of the viewing angle.
// With F0 = F90 = 1 it is below 1 by the light that microfacets scatter more than once.
struct SpecularAlbedo {
  float a, b;

  float white() const { return a + b; }  // with F0 = F90 = 1

  SpecularAlbedo& operator+=(const SpecularAlbedo& other) {
    a += other.a, b += other.b;
    return *this;
  }
  friend SpecularAlbedo operator*(float factor, const SpecularAlbedo& s) {
    return {factor * s.a, factor * s.b};
  }
  friend SpecularAlbedo mix(const SpecularAlbedo& x, const SpecularAlbedo& y, float t) {
    return {x.a + t * (y.a - x.a), x.b + t * (y.b - x.b)};
  }
};

// A table over perceptual roughness r = sqrt(alpha) and the cosine mu of the viewing angle. 32 x 64
// nodes, 16 KB; takes 0.12 s of one core to build, on all cores.
class EnergyTable {
 public:
  static constexpr int kRoughnesses = 32, kAngles = 64;

  EnergyTable();

  // Nodes of the table, and of the averages over angles; the next in memory is of the next angle,
  // or roughness.
  const SpecularAlbedo& node(int roughness, int angle) const {
    return grid_.node({roughness, angle});
  }
  const SpecularAlbedo& averageNode(int roughness) const { return averages_.node({roughness}); }

  // One roughness, ready for any angle. The table must outlive it.
  class Row {
   public:
    SpecularAlbedo at(float mu) const;
    SpecularAlbedo average() const { return average_; }  // cosine-weighted: 2 int E(mu) mu dmu

   private:
    friend class EnergyTable;
    using Grid = GridTable<SpecularAlbedo, kRoughnesses, kAngles>;
    Row(const Grid& grid, GridPosition roughness, const SpecularAlbedo& average)
        : grid_(&grid), roughness_(roughness), average_(average) {}

    const Grid* grid_;
    GridPosition roughness_;
    SpecularAlbedo average_;
  };
  Row row(float roughness) const;

 private:
  GridTable<SpecularAlbedo, kRoughnesses, kAngles> grid_;
  GridTable<SpecularAlbedo, kRoughnesses> averages_;
};

// Albedo of anisotropic GGX reflection in one bounce, for energy compensation.

// A table over perceptual roughness, strength of the anisotropy, and the viewing direction's cosine
// and azimuth. 16 x 9 x 16 x 7 nodes, 126 KB; takes 0.14 s of one core to build, on all cores.
class AnisotropicTable {
 public:
  AnisotropicTable();

  // `wo`: viewing direction, unit, the tangent along x and the normal along z. Roughness and
  // strength in [0, 1].
  SpecularAlbedo albedo(const vec3& wo, float roughness, float strength) const;

 private:
  static constexpr int kRoughnesses = 16, kStrengths = 9, kAngles = 16, kAzimuths = 7;
  GridTable<SpecularAlbedo, kRoughnesses, kStrengths, kAngles, kAzimuths> grid_;
};

// Common parts of the albedo tables: the positions of their nodes, and the integral at a node.

// Perceptual roughness and cosine of the viewing angle at node i of `count`. Both go as t^2, so
// that the nodes are dense at smooth surfaces and grazing angles, where the albedo is curved.
inline float roughnessNode(int i, int count) {
  const float t = float(i) / float(count - 1);
  return std::max(t * t, 0.01f);
}
inline float angleNode(int i, int count) {
  const float t = float(i) / float(count - 1);
  return std::max(t * t, 1e-4f);
}

inline std::vector<vec2> quadraturePoints(uint32_t count) {
  std::vector<vec2> points(count);
  for (uint32_t i = 0; i < count; ++i) points[i] = {toUnit(sobol(i, 0)), toUnit(sobol(i, 1))};
  return points;
}

// The mean over visible normals h of F(wo.h) G2/G1 (Heitz 2018, "Sampling the GGX Distribution of
// Visible Normals", eq. 19). `Alpha`: float, or vec2 for anisotropic GGX.
template <class Alpha>
SpecularAlbedo specularAlbedo(const vec3& wo, const Alpha& alpha, std::span<const vec2> points) {
  const float lambdaO = ggx::lambda(wo, alpha);
  double a = 0, b = 0;
  for (const vec2& u : points) {
    const vec3 h = ggx::sampleVisibleNormal(wo, alpha, u);
    const float woH = glm::dot(wo, h);
    const vec3 wi = 2 * woH * h - wo;
    if (wi.z <= 0) continue;
    const float weight = (1 + lambdaO) / (1 + lambdaO + ggx::lambda(wi, alpha));
    const float c = 1 - woH, grazing = c * c * c * c * c;
    a += double(weight) * (1 - grazing);
    b += double(weight) * grazing;
  }
  return {float(a / double(points.size())), float(b / double(points.size()))};
}

// Albedo of the white sheen lobe, which attenuates the layers beneath.

// A table over perceptual roughness and the cosine of the viewing angle. 24 x 32 nodes, 3 KB; takes
// 0.14 s of one core to build, on all cores.
class SheenTable {
 public:
  SheenTable();

  // `mu`: cosine of the viewing angle; roughness in [charlie::kMinRoughness, 1].
  float albedo(float mu, float roughness) const;

 private:
  static constexpr int kRoughnesses = 24, kAngles = 32;
  GridTable<float, kRoughnesses, kAngles> grid_;
};

// Albedo of a rough boundary between dielectrics in one bounce, for energy compensation.

// Albedo in one bounce, reflection plus refraction, of GGX microfacets without absorption. It is
// below 1 by the masked light, which would be scattered again. The facets reflect all light above
// the critical angle, and below it a fraction that is affine in Fresnel's reflectance F:
//   reflectance = offset + slope F,   albedo = plain + offset a + slope b.
struct GlassAlbedo {
  float plain, a, b;
  float at(float offset, float slope) const { return plain + offset * a + slope * b; }

  friend GlassAlbedo mix(const GlassAlbedo& x, const GlassAlbedo& y, float t) {
    return {glm::mix(x.plain, y.plain, t), glm::mix(x.a, y.a, t), glm::mix(x.b, y.b, t)};
  }
};

// A table over the index of refraction, perceptual roughness and the cosine of the viewing angle.
// 49 x 20 x 40 nodes, 460 KB; takes 0.33 s of one core to build, on all cores.
class GlassTable {
 public:
  GlassTable();

  // `mu`: cosine of the viewing angle; `eta` as in fresnel.h; perceptual roughness in [0, 1].
  GlassAlbedo albedo(float mu, float roughness, float eta) const;

 private:
  static constexpr int kEtas = 49, kRoughnesses = 20, kAngles = 40;
  GridTable<GlassAlbedo, kEtas, kRoughnesses, kAngles> grid_;
};

// The tables that the materials need: none for Lambertian materials. Each takes up to 0.3 s of one
// core, once in a process: all scenes share them. Must outlive the BSDFs.
struct BsdfTables {
  // `widened`: smooth materials may become rough (transport/path_settings.h).
  explicit BsdfTables(std::span<const Material> materials, bool widened = false);
  // Makes the tables that are missing.
  void complete(std::span<const Material> materials, bool widened = false);

  std::shared_ptr<const EnergyTable> energy;
  std::shared_ptr<const AnisotropicTable> anisotropic;
  std::shared_ptr<const SheenTable> sheen;
  std::shared_ptr<const GlassTable> glass;
};

}  // namespace chromeball
