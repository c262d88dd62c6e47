// SPDX-License-Identifier: Apache-2.0
// Constellations as area lights: their samples, their energy and irradiance, and their shadows.
#include "lighting/area_lights.h"

#include <gtest/gtest.h>

#include "lighting/methods.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/sun_extraction.h"
#include "probe/synth.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_scene.h"
#include "transport/path_settings.h"

namespace chromeball::area_lights_test {
namespace {

constexpr const char* kRegions[] = {"median-cut-area", "median-cut-centre-area",
                                    "median-cut-flat-area", "kollig-keller-average"};

std::unique_ptr<LightSource> make(const std::string& name, const Probe& probe) {
  return makeStrategy(name, probe, Mis::Balance, "test");
}

Image sunOverASky() {
  Image map = gradientProbe({32, 16}, Rgb(1, 2, 3), {0.5, 0.4, 0.2});
  map.setRgb(9, 5, Rgb(80, 60, 40));
  return map;
}

struct Case {
  const char* name;
  Image map;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"constant", constantProbe({16, 8}, Rgb(0.3f))});
  all.push_back({"one texel", oneHotProbe({16, 8}, 11, 5, Rgb(1))});
  all.push_back({"pole", oneHotProbe({8, 4}, 3, 0, Rgb(1))});
  all.push_back({"1x1", constantProbe({1, 1}, Rgb(2))});
  all.push_back({"sun over a sky", sunOverASky()});
  return all;
}

// The samples of a hit are a mixture; one of them is drawn at random.
void expectSamplesFollowThePdf(const std::string& name, const Case& c, int depth, int tests) {
  SCOPED_TRACE(name + ", " + c.name + ", depth " + std::to_string(depth));
  const Probe probe(c.map, 33);
  const auto lighting = make(name, probe);
  Samples samples(*lighting, {0, 1, 0}, depth);
  const size_t count = samples.take(0).size();
  ASSERT_GT(count, 0u);
  const SphereTest test = testDirections(
      [&](int i) -> std::optional<vec3> {
        const std::vector<DirectionSample>& all = samples.take(i);
        return all.size() == count ? std::optional(all[size_t(i) % count].wi) : std::nullopt;
      },
      [&](const vec3& w) { return lighting->escaped(samples.point(), w).pdf / double(count); },
      60000, 3, 12, 24);
  EXPECT_NEAR(test.totalProbability, 1, 5e-3);
  EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, tests));
}

TEST(SlowAreaLights, SamplesFollowThePdf) {
  const std::vector<Case> all = cases();
  for (const Case& c : all)
    for (const char* name : {"median-cut-area:7", "median-cut-disc:7", "kollig-keller-average:7"})
      for (const int depth : {0, 1})
        expectSamplesFollowThePdf(name, c, depth, int(all.size()) * 3 * 2);
}

TEST(AreaLights, SamplesHaveTheRadianceAndPdfOfTheirDirection) {
  for (const Case& c : cases())
    for (const char* name :
         {"median-cut-flat-area:6", "median-cut-disc:6", "kollig-keller-average:6"})
      for (const int depth : {0, 1}) {
        SCOPED_TRACE(c.name);
        const Probe probe(c.map, 12);
        const auto lighting = make(name, probe);
        Samples samples(*lighting, {0, 1, 0}, depth);
        int strays = 0, count = 0;
        for (int i = 0; i < 2000; ++i)
          for (const DirectionSample& s : samples.take(i)) {
            ASSERT_NEAR(glm::length(s.wi), 1, 1e-5);
            const auto escaped = lighting->escaped(samples.point(), s.wi);
            const bool same = std::fabs(escaped.pdf / s.pdf - 1) < 1e-4 &&
                              luminance(absolute(escaped.radiance - s.irradiance * s.pdf)) <
                                  1e-4 * luminance(escaped.radiance);
            strays += !same;  // rounded into the neighbour
            ++count;
          }
        EXPECT_LT(strays, 1e-3 * count) << name;
      }
}

// With a region for each texel the lights are the map itself: neither shifted nor turned.
TEST(AreaLights, AreTheMapIfThereIsARegionForEachTexel) {
  Image map(16, 8, 3);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) map.setRgb(x, y, Rgb(1 + x, 1 + y, 1 + x * y));
  const float rotation = 33;
  const Probe probe(map, rotation);
  const glm::dquat turn = glm::angleAxis(glm::radians(double(rotation)), dvec3(0, 1, 0));
  for (const char* name : kRegions) {
    const auto lighting = make(name + std::string(":4096"), probe);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) {
        const Rgb found =
            lighting->escaped({}, vec3(turn * texelDirection({16, 8}, x, y))).radiance;
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k] / map.rgb(x, y)[k], 1, 1e-5) << name;
      }
  }
}

// A map that is constant over each region, with the light of the strategy.
Image piecewiseConstant(const LightSource& lighting, int width, int height) {
  Image map(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      map.setRgb(x, y, lighting.escaped({}, vec3(texelDirection({width, height}, x, y))).radiance);
  return map;
}

// Irradiance estimated by light samples and, with MIS, cosine-distributed BSDF samples.
double estimate(const LightSource& lighting, Samples& samples, Mis mis, int i) {
  const Frame frame(samples.point().normal);
  double sum = 0;
  for (const DirectionSample& s : samples.take(i)) {
    const float cosine = std::max(0.0f, glm::dot(frame.z, s.wi));
    sum += luminance(s.irradiance) * cosine * lightSampleWeight(mis, s.pdf, cosine / kPi);
  }
  const vec3 local = squareToCosineHemisphere(random2(i, 0));
  const auto escaped = lighting.escaped(samples.point(), frame.toWorld(local));
  const float pdf = squareToCosineHemispherePdf(local);
  return sum + kPi * luminance(escaped.radiance) * bsdfSampleWeight(mis, pdf, escaped.pdf);
}

constexpr Mis kAll[] = {Mis::Off, Mis::Balance, Mis::Power};

void expectIrradiance(const LightSource& lighting, const vec3& normal, double expected, int tests) {
  for (const Mis mis : kAll)
    for (const int depth : {0, 1}) {
      Samples samples(lighting, normal, depth);
      std::vector<double> draws;
      for (int i = 0; i < 20000; ++i) draws.push_back(estimate(lighting, samples, mis, i));
      const Moments m = Moments::of(draws);
      EXPECT_GT(tTest(m, expected), sidak(1e-3, tests))
          << m.mean << " and " << expected << ", mis " << int(mis) << ", depth " << depth;
      EXPECT_NEAR(m.mean / expected, 1, 0.02);
    }
}

// Without shadows, the mean over the draws is the irradiance of the map with the average radiance
// of each region, exactly summed.
TEST(AreaLights, GiveTheIrradianceOfThePiecewiseConstantMap) {
  const Image sky = sunOverASky();
  const Probe probe(sky);
  const vec3 normals[] = {glm::normalize(vec3(0.2f, 0.9f, -0.3f)), {-1, 0, 0}};
  for (const char* name : kRegions) {
    SCOPED_TRACE(name);
    const auto lighting = make(name + std::string(":12"), probe);
    const Image map = piecewiseConstant(*lighting, sky.width, sky.height);
    const dvec3 before = meanRadiance(sky), after = meanRadiance(map);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k] / before[k], 1, 1e-5);
    // The map is finer, so that the horizon cuts small texels.
    Image fine(sky.width * 16, sky.height * 16, 3);
    for (int y = 0; y < fine.height; ++y)
      for (int x = 0; x < fine.width; ++x) fine.setRgb(x, y, map.rgb(x / 16, y / 16));
    const std::vector<dvec3> exact = exactIrradiance(fine, normals);
    for (size_t i = 0; i < 2; ++i)
      expectIrradiance(*lighting, normals[i], luminance(exact[i]), 4 * 2 * 6);
  }
}

TEST(AreaLights, DiscsGiveTheirIrradianceInClosedForm) {
  const Image sky = sunOverASky();
  const Probe probe(sky, 70);
  const RegionAreas regions(
      sky, lightMethod("median-cut", "").lights.regions(sky, {.count = 24}).partition, 70);
  const auto lighting = make("median-cut-disc:24", probe);
  const vec3 normal = glm::normalize(vec3(0.2f, 0.9f, -0.3f));
  double expected = 0;
  for (const AreaLight& light : regions.lights()) {
    const double cosine = 1 - light.solidAngle / (2 * kPiD);  // of the disc's radius
    const dvec3 facing = kPiD * (1 - cosine * cosine) * dvec3(light.radiance());
    const Sun disc{dvec3(light.direction), facing, 360 / kPiD * std::acos(cosine)};
    expected += luminance(disc.irradianceOn(dvec3(normal)));
  }
  expectIrradiance(*lighting, normal, expected, 6);
}

TEST(AreaLights, BlackProbesHaveNoLights) {
  const Probe probe(constantProbe({8, 4}, Rgb(0)));
  for (const char* name : {"median-cut-area", "median-cut-disc", "kollig-keller-average"}) {
    const auto lighting = make(name, probe);
    for (const int depth : {0, 1}) {
      Samples samples(*lighting, {0, 1, 0}, depth);
      EXPECT_TRUE(samples.take(0).empty());
      EXPECT_EQ(lighting->escaped(samples.point(), {0, 1, 0}).radiance, Rgb(0));
      EXPECT_EQ(lighting->escaped(samples.point(), {0, 1, 0}).pdf, 0);
    }
  }
}

// The number of steps in the edge of a pillar's shadow on a floor, under a window 60 degrees wide.
int shadowSteps(const std::string& strategy) {
  Image window(96, 48, 3);
  for (int x = 40; x < 56; ++x) window.setRgb(x, 12, Rgb(100));  // around -Z, 45 degrees up
  Scene scene;
  const int white = addMaterial(scene, lambert(Rgb(1)));
  addQuad(scene, white, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});
  addQuad(scene, white, {-4, 0, 0}, {4, 0, 0}, {0, 5, 0});  // its right edge is at (0, y, 0)
  const int width = 80;
  const Camera camera =
      Camera::lookAt({0, 3, 1}, {0, 0, 1}, {0, 0, -1}, 2 * std::atan(0.8f / float(width) / 3));
  const Image row =
      renderScene(scene, camera, Probe(window), strategy, smallRender(width, 1, 256, 1))
          .film.mean();
  const float rise = row.at(width - 1, 0)[1] - row.at(0, 0)[1];
  EXPECT_GT(rise, 0.1f);
  // The penumbra is 58 pixels wide; a step is a run of pixels among which light increases by more
  // than a quarter of the mean slope there.
  int steps = 0;
  bool rises = false;
  for (int x = 1; x < width; ++x) {
    const bool now = row.at(x, 0)[1] - row.at(x - 1, 0)[1] > 0.25f * rise / 58;
    steps += now && !rises;
    rises = now;
  }
  return steps;
}

TEST(AreaLights, ThePenumbraOfAPillarHasOneStepInsteadOfOneForEachLight) {
  for (const int lights : {4, 8, 16}) {
    EXPECT_EQ(shadowSteps("median-cut:" + std::to_string(lights)), lights);
    EXPECT_EQ(shadowSteps("median-cut-area:" + std::to_string(lights)), 1);
  }
}

}  // namespace
}  // namespace chromeball::area_lights_test
