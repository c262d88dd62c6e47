// SPDX-License-Identifier: Apache-2.0
// `product`: its pdf, and its low variance on a Lambertian surface.
#include "lighting/product.h"

#include <gtest/gtest.h>

#include "lighting/importance.h"
#include "probe/synth.h"
#include "sphere_test.h"
#include "test_probes.h"

namespace chromeball::product_test {
namespace {

LightPoint pointWith(const vec3& normal, bool transmits = false) {
  LightPoint point{};
  point.normal = normal;
  point.transmits = transmits;
  return point;
}

TEST(SlowProduct, samplesFollowThePdfOnEveryProbe) {
  const std::vector<HardProbe> all = hardProbes();
  for (size_t k = 0; k < all.size(); ++k)
    for (const bool transmits : {false, true}) {
      if (transmits && k % 3 != 0) continue;
      SCOPED_TRACE(all[k].name);
      const LightPoint point = pointWith(squareToUniformSphere(random2(int(k), 11)), transmits);
      const Probe probe(all[k].image, 33);
      const Product product(probe);
      const SphereTest test = testDirections(
          [&](int i) {
            return std::optional(
                product.sampleDirection(point, double(random1(i, 0)), double(random1(i, 1))).wi);
          },
          [&](const vec3& w) { return product.escaped(point, w).pdf; }, 100000, 4, 12, 24);
      EXPECT_NEAR(test.totalProbability, 1, 5e-3);
      EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, 2 * int(all.size())));
    }
}

// Transmitted light comes from behind, where the bin of the normal has almost no probability.
TEST(Product, transmissiveSurfacesSampleBothSidesEqually) {
  const Probe probe(constantProbe({64, 32}, Rgb(1)));
  const Product product(probe);
  const LightPoint point = pointWith(glm::normalize(vec3(0.3f, 0.8f, -0.5f)), true);
  int behind = 0;
  for (int i = 0; i < 10000; ++i)
    behind +=
        glm::dot(product.sampleDirection(point, random1(i, 0), random1(i, 1)).wi, point.normal) < 0;
  EXPECT_NEAR(behind, 5000, 250);
}

TEST(Product, pdfOfSamplesAgreesWithPdfOfDirectionsAndIsPositiveWhereThereIsLight) {
  for (const HardProbe& c : hardProbes()) {
    SCOPED_TRACE(c.name);
    const Probe probe(c.image);
    const Product product(probe);
    for (int i = 0; i < 20000; ++i) {
      const vec3 normal = squareToUniformSphere(random2(i, 0));
      const LightPoint point = pointWith(normal);
      const DirectionSample s =
          product.sampleDirection(pointWith(normal), random1(i, 2), random1(i, 3));
      ASSERT_GT(s.pdf, 0);
      const vec3 w = squareToUniformSphere(random2(i, 4));
      if (luminance(probe.radiance(w)) > 0) {
        ASSERT_GT(product.escaped(point, w).pdf, 0);
      }
    }
  }
}

// Relative variance of the irradiance estimated by single samples.
double irradianceVariance(const std::function<DirectionSample(double, double)>& draw,
                          const vec3& normal) {
  constexpr int kSamples = 100000;
  double sum = 0, sumOfSquares = 0;
  for (int i = 0; i < kSamples; ++i) {
    const DirectionSample s = draw(random1(i, 0), random1(i, 1));
    const double e = luminance(s.irradiance) * std::max(glm::dot(normal, s.wi), 0.0f);
    sum += e;
    sumOfSquares += e * e;
  }
  const double mean = sum / kSamples;
  return (sumOfSquares / kSamples - mean * mean) / (mean * mean);
}

TEST(Product, hasATenthOfTheVarianceOfImportance) {
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.2, -0.7, 0.3}));
  const Product product(probe);
  const Importance importance(probe, false);
  for (int i = 0; i < 10; ++i) {
    const vec3 normal = squareToUniformSphere(random2(i, 7));
    EXPECT_LT(
        irradianceVariance(
            [&](double u, double v) { return product.sampleDirection(pointWith(normal), u, v); },
            normal),
        0.1 * irradianceVariance(
                  [&](double u, double v) { return importance.sampleDirection(u, v); }, normal));
  }
}

TEST(Product, blackProbesGiveNoSamples) {
  const Probe probe(constantProbe({8, 4}, Rgb(0)));
  const Product product(probe);
  EXPECT_EQ(product.sampleDirection(pointWith(vec3(0, 1, 0)), 0.3, 0.4).pdf, 0);
  EXPECT_EQ(product.escaped(pointWith(vec3(0, 1, 0)), vec3(0, 1, 0)).pdf, 0);
}

}  // namespace
}  // namespace chromeball::product_test
