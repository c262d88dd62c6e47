// SPDX-License-Identifier: Apache-2.0
// The fit of directional lights to a probe's irradiance, and its parts.
#include "lighting/fit/irradiance_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "lighting/fit/light_descent.h"
#include "math/dense_solvers.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::irradiance_fit_test {
namespace {

constexpr ImageSize kSize{64, 32};

dvec3 texelDirection(int x, int y, const ImageSize& size = kSize) {
  return *uvToDirection(Mapping::LatLong, {(x + 0.5) / size.width, (y + 0.5) / size.height});
}

// The mean over boxes of factor x factor texels.
Image smaller(const Image& image, int factor) {
  Image result(image.width / factor, image.height / factor, 3);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      Rgb sum(0);
      for (int j = 0; j < factor; ++j)
        for (int i = 0; i < factor; ++i) sum += image.rgb(x * factor + i, y * factor + j);
      result.setRgb(x, y, sum / float(factor * factor));
    }
  return result;
}

Image scaled(Image image, float scale) {
  for (float& texel : image.texels) texel *= scale;
  return image;
}

FittedLights someLights() {
  FittedLights lights;
  lights.directions = {normalize(dvec3(1, 2, -1)), normalize(dvec3(-1, 0.2, 0.4)),
                       normalize(dvec3(0.1, -1, 0.3))};
  lights.irradiances = {dvec3(2, 1, 0.5), dvec3(0.3, 0.4, 0.9), dvec3(0.5, 0.1, 0)};
  return lights;
}

// Normals for sums over the sphere with their solid angles. (The normals of the icosphere do not
// have equal solid angles.)
constexpr ImageSize kNormals{256, 128};

double normalSolidAngle(size_t i) {
  return texelSolidAngle(int(i) / kNormals.width, kNormals.width, kNormals.height);
}

TEST(CosinePattern, ClosedFormsAgreeWithASumOverNormals) {
  const std::vector<vec3> normals = texelDirections(kNormals);
  const dvec3 a = normalize(dvec3(1, 2, -1));
  for (const dvec3& b : {normalize(dvec3(1, 2, -0.9)), normalize(dvec3(-1, 0.3, 0.2)),
                         normalize(dvec3(-1, -1.8, 1))}) {
    const dvec3 s = tangentsOf(a).u, u = tangentsOf(b).s;
    double product = 0, slope = 0, slopeProduct = 0;
    for (size_t i = 0; i < normals.size(); ++i) {
      const dvec3 n(normals[i]);
      const double weight = normalSolidAngle(i);
      if (dot(n, a) <= 0 || dot(n, b) <= 0) continue;
      product += weight * dot(n, a) * dot(n, b);
      slope += weight * dot(n, a) * dot(n, u);
      slopeProduct += weight * dot(n, s) * dot(n, u);
    }
    const CosinePair pair(a, b);
    EXPECT_NEAR(pair.product(), product, 1e-4);
    EXPECT_NEAR(pair.slope(dot(a, u)), slope, 5e-4);
    EXPECT_NEAR(pair.slopeProduct(dot(s, u), dot(s, b), dot(u, a)), slopeProduct, 2e-3);
  }
}

// They agree apart from the extent of a texel or block, which a point does not have.
TEST(RadiancePoints, HaveTheProductsOfTheProbe) {
  const Image probe = studioProbe({128, 64});
  const std::vector<vec3> normals = texelDirections(kNormals);
  const std::vector<dvec3> irradiance = exactIrradiance(probe, normals);
  const RadiancePoints all(probe, 64, 1), merged(probe, 32, 1);
  for (const dvec3& d : someLights().directions) {
    dvec3 expected(0);
    for (size_t i = 0; i < normals.size(); ++i)
      expected += irradiance[i] * (normalSolidAngle(i) * std::max(0.0, dot(dvec3(normals[i]), d)));
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(all.productWith(d).product[c], expected[c], 8e-4 * expected[c]);
      EXPECT_NEAR(merged.productWith(d).product[c], expected[c], 3e-3 * expected[c]);
    }
  }
}

TEST(RadiancePoints, MergeIntoTheEnergyCentroid) {
  const Image probe = oneHotProbe({128, 64}, 20, 17, Rgb(3, 2, 1));
  const PatternProduct p =
      RadiancePoints(probe, 16, 1).productWith(texelDirection(20, 17, {128, 64}));
  // The product of a light with itself is 2/3 pi x its squared irradiance.
  EXPECT_NEAR(p.product.x, 2.0 / 3 * kPiD * 3 * texelSolidAngle(17, 128, 64), 1e-8);
}

TEST(LightDescent, GradientAgreesWithFiniteDifferences) {
  const RadiancePoints probe(studioProbe(kSize), 32, 1);
  FittedLights lights = someLights();
  solveColors(lights, probe, false);
  const std::vector<double> gradient = misfitGradient(lights, probe);
  // With optimal colours the total derivative of the misfit is the partial one (envelope theorem).
  constexpr double kStep = 1e-4;
  for (size_t i = 0; i < gradient.size(); ++i) {
    const Tangents t = tangentsOf(lights.directions[i / 2]);
    const auto misfit = [&](double step) {
      FittedLights moved = lights;
      dvec3& d = moved.directions[i / 2];
      d = normalize(d + step * (i % 2 == 0 ? t.s : t.u));
      solveColors(moved, probe, false);
      return moved.misfit;
    };
    const double difference = (misfit(kStep) - misfit(-kStep)) / (2 * kStep);
    EXPECT_NEAR(gradient[i], difference, 1e-3 * std::max(1.0, std::fabs(difference)));
  }
}

TEST(LightDescent, DoesNotIncreaseTheMisfit) {
  const RadiancePoints probe(studioProbe(kSize), 32, 1);
  FittedLights lights = someLights();
  solveColors(lights, probe, true);
  double last = lights.misfit;
  const double first = last;
  for (int step = 0; step < 10; ++step) {
    descend(lights, probe, true, 1);
    EXPECT_LE(lights.misfit, last);
    last = lights.misfit;
  }
  EXPECT_LT(last, first);
}

TEST(Nonnegative, SatisfiesTheKuhnTuckerConditions) {
  // x >= 0, slope >= 0, and the slope is 0 where x > 0.
  constexpr size_t kUnknowns = 12;
  std::vector<double> A(kUnknowns * kUnknowns), b(kUnknowns);
  for (size_t i = 0; i < kUnknowns; ++i) {
    b[i] = std::sin(3.0 * double(i) + 1);
    for (size_t j = 0; j < kUnknowns; ++j)
      A[i * kUnknowns + j] = std::exp(-0.3 * std::fabs(double(i) - double(j)));
  }
  for (double start : {0.0, 1.0}) {
    const std::vector<double> x = solveNonnegative(A, b, std::vector<double>(kUnknowns, start));
    int positive = 0;
    for (size_t i = 0; i < kUnknowns; ++i) {
      double slope = -b[i];
      for (size_t j = 0; j < kUnknowns; ++j) slope += A[i * kUnknowns + j] * x[j];
      EXPECT_GE(x[i], 0);
      EXPECT_GE(slope, -1e-9);
      EXPECT_NEAR(slope * x[i], 0, 1e-9);
      positive += x[i] > 0;
    }
    EXPECT_GT(positive, 0);
    EXPECT_LT(positive, int(kUnknowns));
  }
}

TEST(IrradianceFit, OneSunIsFoundExactly) {
  const Image probe = oneHotProbe(kSize, 45, 9, Rgb(1000, 900, 700));
  const IrradianceFit fit = fitIrradiance(probe, {.count = 1});
  ASSERT_EQ(fit.lights.size(), 1u);
  const double solidAngle = texelSolidAngle(9, 64, 32);
  EXPECT_LT(distance(dvec3(fit.lights[0].direction), texelDirection(45, 9)), 1e-4);
  EXPECT_NEAR(fit.lights[0].irradiance.x, 1000 * solidAngle, 1e-4 * 1000 * solidAngle);
  EXPECT_NEAR(fit.lights[0].irradiance.z, 700 * solidAngle, 1e-4 * 700 * solidAngle);
  EXPECT_LT(fit.meanError, 0.2);  // not 0: the texel has an extent, the light has none
}

TEST(IrradianceFit, FewTexelsAreRecovered) {
  const std::array<std::array<int, 2>, 6> texels = {
      {{5, 10}, {20, 20}, {33, 6}, {44, 16}, {58, 25}, {10, 29}}};
  const double texelWidth = kPiD / kSize.height;
  for (size_t count : {2u, 3u, 4u, 6u}) {
    Image probe = constantProbe(kSize, Rgb(0));
    for (size_t k = 0; k < count; ++k)
      probe.setRgb(texels[k][0], texels[k][1], Rgb(30 + 20 * k, 50 - 5 * k, 40));
    const IrradianceFit fit = fitIrradiance(probe, {.count = int(count)});
    for (size_t k = 0; k < count; ++k) {
      const auto [x, y] = texels[k];
      const dvec3 expected = texelDirection(x, y);
      const auto nearest =
          std::max_element(fit.lights.begin(), fit.lights.end(), [&](const auto& a, const auto& b) {
            return dot(dvec3(a.direction), expected) < dot(dvec3(b.direction), expected);
          });
      EXPECT_LT(distance(dvec3(nearest->direction), expected), texelWidth) << count;
      const dvec3 irradiance = dvec3(probe.rgb(x, y)) * texelSolidAngle(y, 64, 32);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(nearest->irradiance[c], irradiance[c], 0.01 * irradiance[c]) << count;
    }
  }
}

TEST(IrradianceFit, AmbientLightReplacesAConstantProbe) {
  const IrradianceFit fit =
      fitIrradiance(constantProbe(kSize, Rgb(1, 2, 3)), {.count = 3, .ambient = true});
  EXPECT_EQ(fit.lights.size(), 0u);
  EXPECT_LT(fit.meanError, 0.1);
  EXPECT_NEAR(fit.ambient.z, 3, 0.03);
  EXPECT_GT(fitIrradiance(constantProbe(kSize, Rgb(1, 2, 3)), {.count = 3}).meanError, 5);
}

// Texels of coarse maps are no points: the error is the same as for the same light on a fine map.
TEST(IrradianceFit, OfOneTexelIsThatOfAConstantProbe) {
  const double fine = fitIrradiance(constantProbe(kSize, Rgb(2)), {.count = 4}).meanError;
  for (const ImageSize& size : {ImageSize{1, 1}, {2, 1}, {1, 40}, {100, 1}})
    EXPECT_NEAR(fitIrradiance(constantProbe(size, Rgb(2)), {.count = 4}).meanError / fine, 1, 0.02)
        << size.width << " x " << size.height;
}

TEST(IrradianceFit, ABlackProbeGivesNoLights) {
  const IrradianceFit fit =
      fitIrradiance(constantProbe(kSize, Rgb(0)), {.count = 4, .ambient = true});
  EXPECT_TRUE(fit.lights.empty());
  EXPECT_TRUE(isBlack(fit.ambient));
  EXPECT_EQ(fit.meanError, 0);
}

TEST(IrradianceFit, ScalesWithTheProbe) {
  const Image probe = studioProbe(kSize);
  const IrradianceFit fit = fitIrradiance(probe, {.count = 5});
  for (float scale : {1e-8f, 1e10f}) {
    const IrradianceFit other = fitIrradiance(scaled(probe, scale), {.count = 5});
    for (size_t i = 0; i < fit.lights.size(); ++i) {
      EXPECT_LT(distance(fit.lights[i].direction, other.lights[i].direction), 1e-3);
      EXPECT_NEAR(other.lights[i].irradiance.y / scale, fit.lights[i].irradiance.y,
                  1e-3 * fit.lights[i].irradiance.y);
    }
    EXPECT_NEAR(other.meanError, fit.meanError, 1e-3 * fit.meanError);
  }
}

TEST(IrradianceFit, IsIndependentOfTheNumberOfThreads) {
  const Image probe = studioProbe(kSize);
  const IrradianceFit many = fitIrradiance(probe, {.count = 4});
  const ThreadLimit one(1);
  const IrradianceFit single = fitIrradiance(probe, {.count = 4});
  for (size_t i = 0; i < many.lights.size(); ++i) {
    EXPECT_EQ(many.lights[i].direction, single.lights[i].direction);
    EXPECT_EQ(many.lights[i].irradiance, single.lights[i].irradiance);
  }
}

TEST(IrradianceFit, ReportsTheErrorOfItsLights) {
  const Image probe = studioProbe(kSize);
  const IrradianceFit fit = fitIrradiance(probe, {.count = 3, .ambient = true});
  const std::vector<vec3> normals = icosphereNormals(5);
  const LightError error =
      lightError(irradianceOf(fit.lights, fit.ambient, normals), exactIrradiance(probe, normals));
  EXPECT_EQ(fit.meanError, error.mean);
  EXPECT_EQ(fit.maxError, error.max);
}

TEST(IrradianceFit, MaxErrorGivesTheSmallestNumberOfLights) {
  const Image probe = studioProbe(kSize);
  FitOptions options;
  options.maxErrorPercent = 5;
  const IrradianceFit fit = fitIrradiance(probe, options);
  const int count = int(fit.lights.size());
  EXPECT_LE(fit.meanError, 5);
  ASSERT_GT(count, 1);
  EXPECT_GT(fitIrradiance(probe, {.count = count - 1}).meanError, 5);
  EXPECT_EQ(fitIrradiance(probe, {.count = count}).meanError, fit.meanError);

  options.maxErrorPercent = 0;
  options.maxCount = 2;
  EXPECT_EQ(fitIrradiance(probe, options).lights.size(), 2u);
}

TEST(IrradianceFit, RejectsANegativeCount) {
  EXPECT_ANY_THROW(fitIrradiance(studioProbe(kSize), {.count = -1}));
}

void expectErrorsToFall(const Image& probe, const std::vector<int>& counts) {
  double last = 100;
  for (int count : counts) {
    const double error = fitIrradiance(probe, {.count = count}).meanError;
    EXPECT_LE(error, last) << count << " lights";
    last = error;
  }
  EXPECT_LT(last, 0.2);
}

TEST(SlowIrradianceFit, ErrorFallsWithTheCountInAStudio) {
  expectErrorsToFall(studioProbe(kSize), {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 15, 16, 17, 18, 32, 64});
}

TEST(SlowIrradianceFit, ErrorFallsWithTheCountUnderTheSky) {
  expectErrorsToFall(clearSkyProbe(kSize, {}), {1, 2, 3, 4, 5, 6, 7, 8, 16, 17, 32, 64});
}

TEST(SlowIrradianceFit, GalileosTombNeedsFewLights) {
  const auto path = sharedData("probes/debevec/galileo_probe.hdr");
  if (!path) GTEST_SKIP() << "no Galileo probe";
  const Image probe = smaller(loadProbe(*path).latLong, 8);
  expectErrorsToFall(probe, {1, 2, 4, 16, 32, 64});
  // Errors of an independent least-squares fit from many starts.
  const std::pair<int, double> reached[] = {{3, 10.1}, {5, 2.6}, {8, 1.4}, {12, 0.80}};
  for (const auto& [count, mean] : reached)
    EXPECT_LE(fitIrradiance(probe, {.count = count}).meanError, mean) << count << " lights";
  FitOptions options;
  options.maxErrorPercent = 5;
  // Madsen and Laursen need five to six lights.
  EXPECT_LE(fitIrradiance(probe, options).lights.size(), 6u);
}

}  // namespace
}  // namespace chromeball::irradiance_fit_test
