// SPDX-License-Identifier: Apache-2.0
// `suns`: pdfs, radiance, and the penumbras of its discs.
#include <gtest/gtest.h>

#include "lighting/suns.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_scene.h"
#include "transport/path_settings.h"

namespace chromeball::suns_test {
namespace {

// A sky that is bright around its suns, so that the sampling techniques overlap.
Image sunnySky(int suns) {
  Image map = gradientProbe({128, 64}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1});
  for (int i = 0; i < suns; ++i) {
    const ClearSky sky{.sunElevation = 80.0 - 15 * i, .sunAzimuth = 180.0 + 65 * i};
    addSunDisc(map, sunDirection(sky), 1.5, dvec3(2.0 + i, 2, 1.5));
  }
  return map;
}

// The pdf is the mixture density of all samples of a point.
TEST(Suns, PdfIsTheMixtureOfAllSamples) {
  for (const int count : {2, 6}) {  // with 2, all suns are sampled; with 6, one is chosen
    SCOPED_TRACE(count);
    const Probe probe(sunnySky(count), 40);
    const Suns suns(probe, false, 25.0);  // wide enough to overlap one another and the bins
    Samples samples(suns, {0, 1, 0});
    const int each = count <= 2 ? count + 1 : 2;
    const auto draw = [&](int i) -> std::optional<vec3> {
      const auto& taken = samples.take(i / each);
      EXPECT_EQ(int(taken.size()), each);
      const DirectionSample& s = taken[size_t(i % each)];
      const auto escaped = suns.escaped(samples.point(), s.wi);
      EXPECT_EQ(s.pdf, escaped.pdf);
      EXPECT_NEAR(s.irradiance.x * s.pdf / escaped.radiance.x, 1, 1e-5);
      EXPECT_NEAR(escaped.radiance.y / suns.background({}, s.wi).y, 1, 1e-5);
      return s.wi;
    };
    const SphereTest test = testDirections(
        draw, [&](const vec3& wi) { return suns.escaped(samples.point(), wi).pdf / each; }, 60000);
    EXPECT_NEAR(test.totalProbability, 1, 2e-3);
    EXPECT_GT(test.chiSquare.pValue, 1e-3);
  }
}

// Irradiance from a strategy's radiance, by quadrature.
dvec3 irradianceOf(const LightSource& strategy, const vec3& normal) {
  constexpr int kWidth = 1600, kHeight = 800;
  dvec3 sum(0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double theta = kPiD * (y + 0.5) / kHeight, phi = 2 * kPiD * (x + 0.5) / kWidth;
      const vec3 d(
          dvec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
      sum += dvec3(strategy.background({}, d)) * (std::sin(theta) * std::max(0.0f, dot(normal, d)));
    }
  return sum * (2 * kPiD * kPiD / (double(kWidth) * kHeight));
}

TEST(Suns, EstimatesAreUnbiasedWhereTechniquesOverlap) {
  for (const int count : {0, 1, 2, 6})
    for (const bool compensated : {false, true}) {
      SCOPED_TRACE(testing::Message() << count << " suns, compensated: " << compensated);
      const Probe probe(sunnySky(count), -25);
      const Suns suns(probe, compensated, 30.0);
      const vec3 normal = glm::normalize(vec3(0.5f, 0.7f, -0.3f));
      const Frame frame(normal);
      Samples samples(suns, normal);
      std::vector<double> estimates;
      for (int i = 0; i < 20000; ++i) {
        double sum = 0;
        // Light samples and, if compensated, BSDF samples of a white surface, combined by the
        // balance heuristic: compensation leaves a part of the probe to BSDF samples.
        for (const DirectionSample& s : samples.take(i)) {
          const float cosine = std::max(0.0f, glm::dot(normal, s.wi));
          const float weight = compensated ? misWeight(Mis::Balance, s.pdf, cosine / kPi) : 1;
          sum += luminance(s.irradiance) * cosine * weight;
        }
        if (compensated) {
          const vec3 wi = frame.toWorld(squareToCosineHemisphere(random2(i, 0)));
          const float pdf = std::max(1e-6f, glm::dot(normal, wi) / kPi);
          const auto escaped = suns.escaped(samples.point(), wi);
          sum +=
              kPi * luminance(escaped.radiance) * bsdfSampleWeight(Mis::Balance, pdf, escaped.pdf);
        }
        estimates.push_back(sum);
      }
      const double expected = luminance(Rgb(irradianceOf(suns, normal)));
      const Moments moments = Moments::of(estimates);
      EXPECT_GT(tTest(moments, expected), sidak(1e-3, 8)) << moments.mean << " and " << expected;
    }
}

// The background differs from the probe only in the shape of the suns.
TEST(Suns, PreserveTheProbesIrradiance) {
  const Probe probe(sunnySky(2), 70);
  for (const vec3 n : {vec3(0, 1, 0), vec3(1, 3, 1), vec3(0.3f, 1, -0.2f)}) {
    const vec3 normal = glm::normalize(n);
    const dvec3 whole = irradianceOf(Importance(probe, false), normal);
    for (const double angle : {15.0, 40.0}) {  // above the horizon, and wide relative to the grid
      const dvec3 found = irradianceOf(Suns(probe, false, angle), normal);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / whole[c], 1, 0.002);
    }
  }
}

TEST(Suns, WithoutSunsEqualsImportance) {
  const Probe probe(overcastProbe({64, 32}, Rgb(1), 0.2), 33);
  const Suns suns(probe, false);
  const Importance importance(probe, false);
  Samples a(suns, {0, 1, 0}), b(importance, {0, 1, 0});
  for (int i = 0; i < 1000; ++i) {
    const auto& sample = a.take(i);
    ASSERT_EQ(sample.size(), 1u);
    EXPECT_EQ(sample[0].wi, b.take(i)[0].wi);
    EXPECT_EQ(sample[0].pdf, importance.pdf(sample[0].wi));
    const Rgb background = suns.background({}, sample[0].wi),
              radiance = probe.radiance(sample[0].wi);
    for (int c = 0; c < 3; ++c)  // two compilations of the same interpolation round differently
      EXPECT_FLOAT_EQ(background[c], radiance[c]);
  }
  const Probe black(constantProbe({8, 4}, Rgb(0)));
  EXPECT_TRUE(Samples(Suns(black, false), {0, 1, 0}).take(0).empty());
}

// A straight edge at height h under a sun overhead casts a penumbra of width 2 h tan(angle / 2).
// The visible fraction of the disc in it equals that of a circle cut by a chord.
TEST(Suns, PenumbraOfAStraightEdge) {
  constexpr float kHeight = 2, kView = 1;  // metres; kView: width of the visible area
  constexpr int kWidth = 100;
  Image map = constantProbe({256, 128}, Rgb(0));
  addSunDisc(map, {0, 1, 0}, 3, {3, 2, 1});
  const Probe probe(map);
  Scene scene;
  const int white = addMaterial(scene, lambert(Rgb(1)));
  addQuad(scene, white, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100});
  addQuad(scene, white, {-50, kHeight, 50}, {50, 0, 0}, {0, 0, -100});
  const World world(scene);
  const std::atomic<bool> stop = false;
  const float fov = 2 * std::atan(0.5f * kView) * 180 / kPi;  // seen from 1 m, below the edge
  const Camera camera = topCamera(1, fov);
  for (const double angle : {5.0, 20.0}) {
    const Suns suns(probe, false, angle);
    const RenderSettings settings = smallRender(kWidth, kWidth, 16, 1);
    const Image image = render(
                            world, camera, suns, settings, [](double) {}, stop)
                            .film.mean();
    const double halfWidth = kHeight * std::tan(angle * kPiD / 360);
    std::vector<double> profile(kWidth);
    for (int x = 0; x < kWidth; ++x)
      for (int y = 0; y < kWidth; ++y) profile[size_t(x)] += image.rgb(x, y).y / kWidth;
    const double lit = 2 / kPiD;  // irradiance / pi
    for (int x = 0; x < kWidth; ++x) {
      const double t = std::clamp(-kView * ((x + 0.5) / kWidth - 0.5) / halfWidth, -1.0, 1.0);
      const double seen = (std::acos(t) - t * std::sqrt(1 - t * t)) / kPiD;
      EXPECT_NEAR(profile[size_t(x)] / lit, seen, 0.02) << angle << ", column " << x;
      if (t == 1) {
        EXPECT_EQ(profile[size_t(x)], 0) << angle << ", column " << x;
      }
      if (t == -1) {
        EXPECT_NEAR(profile[size_t(x)] / lit, 1, 0.01) << angle << ", column " << x;
      }
    }
  }
}

// Discs change the shape of the sources, so the strategy is biased if the probe has suns.
TEST(Suns, IsUnbiasedOnlyWithoutSuns) {
  const Probe sunny(sunnySky(1)), overcast(overcastProbe({64, 32}, Rgb(1), 0.2));
  EXPECT_FALSE(Suns(sunny, true).unbiased());
  EXPECT_TRUE(Suns(overcast, true).unbiased());
}

// Full renders agree with `importance`.
TEST(SlowSuns, RenderAgreesWithImportance) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert({0.7f, 0.6f, 0.5f})), {-3, 0, 3}, {6, 0, 0},
          {0, 0, -6});
  Material plastic = lambert({0.1f, 0.5f, 0.2f});
  plastic.specular = 1;
  plastic.roughness = 0.4f;
  addSphere(scene, addMaterial(scene, plastic), {0, 0.6f, 0}, 0.6f, 24);
  const Probe probe(sunnySky(2), 25);
  const Suns suns(probe, true);
  const Importance importance(probe, true);
  const World world(scene);
  const std::atomic<bool> stop = false;
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const auto brightness = [&](const LightSource& strategy, uint64_t seed) {
    const RenderSettings settings = smallRender(48, 48, 64, 5, seed);
    return double(luminance(meanColor(render(
                                          world, camera, strategy, settings, [](double) {}, stop)
                                          .film.mean())));
  };
  double separate = 0, together = 0;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    separate += brightness(suns, seed);
    together += brightness(importance, 100 + seed);
  }
  EXPECT_NEAR(separate / together, 1, 0.005);
}

}  // namespace
}  // namespace chromeball::suns_test
