// SPDX-License-Identifier: Apache-2.0
// BSDFs without layers: sampling, energy conservation, reciprocity.
#include <gtest/gtest.h>

#include "all_tables.h"
#include "math/sampler.h"
#include "shading/bsdf.h"
#include "shading/ggx.h"
#include "sphere_test.h"

namespace chromeball::bsdf_test {
namespace {

Surface flatSurface() {
  Surface s{};
  s.geometricNormal = s.normal = {0, 0, 1};
  s.frontFace = true;
  return s;
}

MaterialPoint metallicRoughness(float metallic, float roughness, Rgb color = Rgb(1)) {
  return {color, metallic, roughness, Rgb(0.04f), 1};
}

vec3 directionAt(float degrees) {
  const float a = degrees * kPi / 180;
  return {std::sin(a), 0, std::cos(a)};
}

constexpr float kRoughnesses[] = {0.2f, 0.4f, 0.7f, 1};
constexpr float kMetals[] = {0, 0.5f, 1};
constexpr float kAngles[] = {0, 30, 60, 80, 89};

TEST(Ggx, visibleNormalsHaveTheirPdf) {
  for (float alpha : {0.05f, 0.3f, 1.0f})
    for (float angle : {0.0f, 45.0f, 85.0f}) {
      const vec3 wo = directionAt(angle);
      const SphereTest test = testDirections(
          [&](int i) { return std::optional(ggx::sampleVisibleNormal(wo, alpha, random2(i, 0))); },
          [&](const vec3& h) -> double {
            if (h.z <= 0) return 0;
            return ggx::g1(wo.z, alpha) * ggx::distribution(h, alpha) *
                   std::fmax(0.0f, glm::dot(wo, h)) / wo.z;
          },
          100000);
      EXPECT_NEAR(test.totalProbability, 1, 2e-3) << alpha << " " << angle;
      EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, 9)) << alpha << " " << angle;
    }
}

TEST(SlowBsdf, samplesItsPdfOverTheGrid) {
  const int tests = int(std::size(kRoughnesses) * std::size(kMetals) * std::size(kAngles));
  for (float roughness : kRoughnesses)
    for (float metallic : kMetals)
      for (float angle : kAngles) {
        const Bsdf bsdf(metallicRoughness(metallic, roughness, Rgb(0.8f, 0.5f, 0.2f)),
                        flatSurface(), directionAt(angle), allTables());
        const SphereTest test = testDirections(
            [&](int i) -> std::optional<vec3> {
              BsdfSample s;
              if (!bsdf.sample(random2(i, 0), random1(i, 2), s)) return std::nullopt;
              return s.wi;
            },
            [&](const vec3& wi) { return bsdf.evaluate(wi).pdf; }, 100000, 3);
        EXPECT_LT(test.totalProbability, 1 + 2e-3);
        EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, tests))
            << "roughness " << roughness << " metallic " << metallic << " angle " << angle;
      }
}

// Directional albedo, estimated by BSDF sampling.
struct Albedo {
  double mean, error;
};
Albedo albedo(const Bsdf& bsdf, int samples) {
  double sum = 0, sumOfSquares = 0;
  for (int i = 0; i < samples; ++i) {
    BsdfSample s;
    const vec2 u(toUnit(sobol(uint32_t(i), 0)), toUnit(sobol(uint32_t(i), 1)));
    const float lobe = toUnit(sobol(uint32_t(i), 2));
    const double weight = bsdf.sample(u, lobe, s) ? luminance(s.weight) : 0;
    sum += weight;
    sumOfSquares += weight * weight;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(0.0, sumOfSquares / samples - mean * mean) / samples)};
}

TEST(SlowBsdf, whiteFurnaceLosesNothing) {
  for (float roughness : {0.0f, 0.005f, 0.02f, 0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.75f, 0.93f, 1.0f})
    for (float metallic : kMetals)
      for (float angle : {0.0f, 20.0f, 45.0f, 70.0f, 80.0f, 86.0f, 89.0f}) {
        const Bsdf bsdf(metallicRoughness(metallic, roughness), flatSurface(), directionAt(angle),
                        allTables());
        const Albedo a = albedo(bsdf, 1 << 17);
        EXPECT_NEAR(a.mean, 1, 0.005) << roughness << " " << metallic << " " << angle;
        EXPECT_LT(a.mean, 1 + 3e-3) << roughness << " " << metallic << " " << angle;
      }
}

TEST(Bsdf, lambertIsExact) {
  MaterialPoint material = metallicRoughness(0, 1, Rgb(0.8f, 0.4f, 0.1f));
  material.dielectricF0 = Rgb(0);
  material.dielectricF90 = 0;
  const Bsdf bsdf(material, flatSurface(), directionAt(50), allTables());
  for (float angle : {0.0f, 33.0f, 88.0f}) {
    const BsdfValue v = bsdf.evaluate(directionAt(angle));
    EXPECT_NEAR(v.fCos.x, 0.8f * kInvPi * std::cos(angle * kPi / 180), 1e-6);
  }
  BsdfSample s;
  ASSERT_TRUE(bsdf.sample({0.3f, 0.4f}, 0.5f, s));
  EXPECT_EQ(s.weight, Rgb(0.8f, 0.4f, 0.1f));
}

// A material without specular reflection needs no tables.
TEST(Bsdf, lambertNeedsNoTables) {
  const BsdfTables none({});
  const MaterialPoint matte{Rgb(0.5f), 0, 1, Rgb(0), 0};
  const Bsdf bsdf(matte, flatSurface(), directionAt(50), none);
  EXPECT_FALSE(bsdf.isLayered());
  EXPECT_FALSE(bsdf.has(Lobes::Narrow));
  EXPECT_NEAR(bsdf.evaluate({0, 0, 1}).fCos.x, 0.5f * kInvPi, 1e-6f);
}

// Only perfect mirrors are deltas.
TEST(Bsdf, smoothSamplesAreDeltas) {
  for (const float roughness : {0.0f, 0.005f, 0.02f, 0.5f}) {
    const Bsdf bsdf(metallicRoughness(1, roughness), flatSurface(), directionAt(50), allTables());
    BsdfSample s;
    ASSERT_TRUE(bsdf.sample({0.3f, 0.4f}, 0.5f, s));
    EXPECT_EQ(s.isDelta, roughness < 0.01f) << roughness;
    EXPECT_EQ(s.pdf == 0, s.isDelta) << roughness;
    if (s.isDelta) {
      EXPECT_FALSE(bsdf.has(Lobes::Narrow)) << roughness;
    }
  }
}

TEST(Bsdf, isReciprocal) {
  for (float roughness : kRoughnesses)
    for (float metallic : kMetals) {
      const MaterialPoint material = metallicRoughness(metallic, roughness, Rgb(0.9f, 0.5f, 0.3f));
      for (int i = 0; i < 200; ++i) {
        const vec3 a = squareToUniformHemisphere(random2(i, 0));
        const vec3 b = squareToUniformHemisphere(random2(i, 2));
        const Rgb ab = Bsdf(material, flatSurface(), a, allTables()).evaluate(b).fCos / b.z;
        const Rgb ba = Bsdf(material, flatSurface(), b, allTables()).evaluate(a).fCos / a.z;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(ab[c], ba[c], 1e-3 * (ab[c] + 1e-3));
      }
    }
}

TEST(Bsdf, noColourOfDielectricGainsEnergy) {
  for (Rgb color : {Rgb(1, 0.2f, 0), Rgb(0, 0, 1)}) {
    MaterialPoint material = metallicRoughness(0, 0.4f);
    material.dielectricF0 = color * 0.5f;
    for (float angle : kAngles) {
      const Bsdf bsdf(material, flatSurface(), directionAt(angle), allTables());
      Rgb sum(0);
      for (uint32_t i = 0; i < 8192; ++i) {
        BsdfSample s;
        if (bsdf.sample({toUnit(sobol(i, 0)), toUnit(sobol(i, 1))}, toUnit(sobol(i, 2)), s))
          sum += s.weight / 8192.0f;
      }
      EXPECT_LT(maxComponent(sum), 1.003f) << angle;
    }
  }
}

// Shading normals that differ from the geometric normal must neither cause black areas nor let
// light through from behind.
TEST(Bsdf, shadingNormalsNeitherBlackenNorLeak) {
  for (int i = 0; i < 2000; ++i) {
    Surface surface = flatSurface();
    const vec3 wo = squareToUniformHemisphere(random2(i, 0));
    surface.normal = squareToUniformHemisphere(random2(i, 2));
    if (surface.normal.z < 0.3f) continue;
    for (float roughness : {0.0f, 0.1f, 0.5f}) {
      const Bsdf bsdf(metallicRoughness(1, roughness), surface, wo, allTables());
      int passed = 0;
      for (int k = 0; k < 64; ++k) {
        BsdfSample s;
        if (!bsdf.sample(random2(k, 4), random1(k, 6), s)) continue;
        ++passed;
        ASSERT_GT(s.wi.z, 0);
        ASSERT_TRUE(isFinite(s.weight));
        ASSERT_GE(s.weight.x, 0);
      }
      EXPECT_GT(passed, 16) << "roughness " << roughness << " wo.z " << wo.z;
    }
  }
}

}  // namespace
}  // namespace chromeball::bsdf_test
