// SPDX-License-Identifier: Apache-2.0
// tests/ENVELOPE.md: the rows about probes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "base/error.h"
#include "envelope.h"
#include "math/cdf.h"
#include "probe/edit.h"
#include "probe/info.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::envelope_probe_test {
namespace {

constexpr const char* kStrategies[] = {"bsdf",
                                       "uniform",
                                       "importance",
                                       "product",
                                       "suns",
                                       "median-cut:8",
                                       "kollig-keller-strata:4",
                                       "lightgen:4",
                                       "variance-cut:8",
                                       "cube-grid:2",
                                       "kollig-keller:4",
                                       "penrose:32",
                                       "irradiance-fit:2",
                                       "irradiance-fit-ambient:2"};

RenderResult litPlane(const Probe& probe, const std::string& strategy, int samples,
                      const Material& material = lambert(Rgb(0.5f))) {
  return renderScene(plane(material), topCamera(3, 40), probe, strategy,
                     smallRender(16, 16, samples, 1));
}

TEST(EnvelopeProbe, RadianceFrom1e_8To1e10) {
  double noise = 0;
  for (float radiance : {1.0f, 1e-8f, 1e10f}) {
    const Probe probe(gradientProbe({64, 32}, Rgb(radiance), {0.2, 0.6, 0.3}));
    const RenderResult r = litPlane(probe, "importance", 64);
    EXPECT_NEAR(validMean(r) / radiance, 0.5 * (1 + 2.0 / 3 * 0.6), 1e-3) << radiance;
    const double found = r.film.noise().noise;
    if (noise == 0) noise = found;
    EXPECT_NEAR(found / noise, 1, 1e-3) << radiance;  // the noise estimate scales with radiance
  }
}

// Scales by a power of two, which is exact.
Image scaled(Image image, int exponent) {
  for (float& x : image.texels) x = std::ldexp(x, exponent);
  return image;
}

// A bright texel in a gradient.
Image gradientWithSun(float sun) {
  Image image = gradientProbe({32, 16}, Rgb(1), {0.2, 0.6, 0.3});
  image.setRgb(11, 4, Rgb(sun));
  return image;
}

// Scaling the probe by 1e30 or 1e-30 scales the image by the same factor.
TEST(SlowEnvelopeProbe, RadianceFrom1e_30To1e30UnderEveryStrategy) {
  for (const std::string strategy : kStrategies) {
    const double mean = validMean(litPlane(Probe(gradientWithSun(50)), strategy, 16));
    for (const int exponent : {-100, 100}) {
      const Probe probe(scaled(gradientWithSun(50), exponent));
      EXPECT_NEAR(std::ldexp(validMean(litPlane(probe, strategy, 16)), -exponent) / mean, 1, 1e-4)
          << strategy << " 2^" << exponent;
    }
  }
}

// Squares of these radiances overflow or underflow in float.
TEST(SlowEnvelopeProbe, AOneTexelSunOf1e30) {
  for (const float sun : {1e20f, 1e30f})
    for (const std::string strategy : {"importance", "product", "kollig-keller-strata:4", "suns"}) {
      const Probe probe(gradientWithSun(sun));
      const double expected = 0.5 * irradianceOverPi(probe, {0, 1, 0}, 1500);
      EXPECT_NEAR(validMean(litPlane(probe, strategy, 256)) / expected, 1,
                  strategy == "suns" ? 0.02 : 5e-3)
          << strategy << ' ' << sun;
    }
  const Probe dim(scaled(oneHotProbe({32, 16}, 11, 4, Rgb(1)), -80));
  EXPECT_NEAR(
      validMean(litPlane(dim, "importance", 256)) / (0.5 * irradianceOverPi(dim, {0, 1, 0}, 1500)),
      1, 5e-3);
}

// The statistics of a probe and its exact irradiance.
TEST(EnvelopeProbe, StatisticsFrom1e_30To1e30) {
  const Image image = gradientWithSun(1e6f);
  const ProbeInfo info = probeInfo(image);
  ASSERT_EQ(info.suns.size(), 1u);
  const vec3 normal = glm::normalize(vec3(0.3f, 0.9f, 0.1f));
  const double irradiance = exactIrradiance(image, {&normal, 1})[0].y;
  for (const int exponent : {-100, 100}) {
    const Image other = scaled(image, exponent);
    const ProbeInfo found = probeInfo(other);
    ASSERT_EQ(found.suns.size(), 1u) << exponent;
    EXPECT_NEAR(found.suns[0].angle, info.suns[0].angle, 1e-6);
    EXPECT_NEAR(std::ldexp(found.suns[0].irradiance.y, -exponent) / info.suns[0].irradiance.y, 1,
                1e-6);
    EXPECT_NEAR(std::ldexp(found.meanRadiance.y, -exponent) / info.meanRadiance.y, 1, 1e-12);
    EXPECT_NEAR(found.dynamicRange / info.dynamicRange, 1, 1e-6);
    EXPECT_NEAR(found.brightestTexels[0].fraction, info.brightestTexels[0].fraction, 1e-6);
    EXPECT_NEAR(std::ldexp(exactIrradiance(other, {&normal, 1})[0].y, -exponent) / irradiance, 1,
                1e-6);
  }
}

// Squares of radiance exceed the range of float; the film accumulates in double.
TEST(EnvelopeProbe, TheErrorEstimateHoldsFrom1e_35To1e35) {
  for (const float radiance : {1e-35f, 1e-25f, 1.0f, 1e25f, 1e35f}) {
    Film film(1, 1);
    for (int half = 0; half < Film::kHalves; ++half) {
      SampleSums sums;
      for (float x : {0.5f, half == 0 ? 1.5f : 2.0f}) sums.add(Rgb(x * radiance));
      film.add(0, 0, half, sums);
    }
    EXPECT_NEAR(film.mean().rgb(0, 0).x / radiance, 1.125, 1e-5) << radiance;
    EXPECT_NEAR(film.noise().noise, 0.125 / 1.125, 1e-5) << radiance;
    const float variance = varianceImage(film.errors()).texels[0];
    if (radiance > 1e20f) {
      EXPECT_EQ(variance, INFINITY);  // as a float; never 0 or NaN
    }
  }
}

TEST(SlowEnvelopeProbe, ADynamicRangeOf1e12InOneProbe) {
  Image image = constantProbe({32, 16}, Rgb(1e-2f));
  image.setRgb(11, 4, Rgb(1e10f));
  const Probe probe(image);
  const double expected = 0.5 * irradianceOverPi(probe, {0, 1, 0}, 1500);
  for (const char* strategy : {"importance", "suns"})
    // `suns` replaces the bright texel by a disc of slightly different shape.
    EXPECT_NEAR(validMean(litPlane(probe, strategy, 256)) / expected, 1,
                std::string(strategy) == "suns" ? 0.02 : 5e-3)
        << strategy;
  // With the bright texel below the plane, the plane is lit only by the other texels.
  Image below = constantProbe({32, 16}, Rgb(1e-2f));
  below.setRgb(11, 13, Rgb(1e10f));
  const RenderResult r = litPlane(Probe(below), "importance", 4096);  // seen from above
  EXPECT_NEAR(validMean(r) / 5e-3, 1, 0.02);
}

// The CDF is double: beside a texel 1e12 times as bright, the other texels of a row of 16384 can be
// sampled, and their probability has a relative error below 1e-3.
TEST(EnvelopeProbe, TexelsAfterAOneTexelSunKeepTheirProbability) {
  const int width = 16384, sun = 3;
  std::vector<double> weights(width, 1.0);
  weights[sun] = 1e12;
  CdfRows table(1, width);
  const double total = table.setRow(0, weights);
  EXPECT_EQ(total, 1e12 + width - 1);
  for (int column : {sun + 1, 5000, width - 1}) {
    const long double before = 1e12L + column - 1;
    double low = double((before + 0.01L) / total), high = double((before + 0.99L) / total);
    EXPECT_EQ(table.sample(0, low), column);
    EXPECT_EQ(table.sample(0, high), column);
    EXPECT_NEAR(low, 0.01, 1e-3);
    EXPECT_NEAR(high, 0.99, 1e-3);
  }
}

// The largest probe size. One plane is lit by the sun, the other only by the other texels.
TEST(SlowEnvelopeProbe, AOneTexelSunIn16384x8192) {
  if (double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) < 8e9)
    GTEST_SKIP() << "takes 5 GB of memory";
  const int width = 16384, height = 8192, x = 12000, y = 2000;
  Image image = constantProbe({width, height}, Rgb(1));
  image.setRgb(x, y, Rgb(1e9f));
  const Probe probe(image);
  const double sun = 1e9 * texelSolidAngle(y, width, height) * std::cos(kPiD * (y + 0.5) / height);
  EXPECT_NEAR(validMean(litPlane(probe, "importance", 64)) / (0.5 * (1 + sun / kPiD)), 1, 1e-3);

  Scene ceiling;
  addQuad(ceiling, addMaterial(ceiling, lambert(Rgb(0.5f))), {-1, 0, -1}, {2, 0, 0}, {0, 0, 2});
  const Camera below = Camera::lookAt({0, -3, 0}, vec3(0), {0, 0, 1}, 0.3f);
  const RenderResult r =
      renderScene(ceiling, below, probe, "importance", smallRender(16, 16, 1024, 1));
  EXPECT_NEAR(validMean(r), 0.5, 5e-3);
}

TEST(SlowEnvelopeProbe, OddShapesUnderEveryStrategy) {
  struct Case {
    const char* name;
    Image image;
    double expected;  // radiance of a plane of albedo 1/2 facing up; below 0: use quadrature
  };
  Image oneTexel = constantProbe({16, 8}, Rgb(0)), tall = constantProbe({3, 7}, Rgb(1));
  oneTexel.setRgb(6, 1, Rgb(50));
  tall.setRgb(1, 2, Rgb(9));
  const Case cases[] = {{"black", constantProbe({16, 8}, Rgb(0)), 0},
                        {"constant", constantProbe({16, 8}, Rgb(2)), 1},
                        {"1x1", constantProbe({1, 1}, Rgb(2)), 1},
                        {"2x1", constantProbe({2, 1}, Rgb(2)), 1},
                        {"1x5", constantProbe({1, 5}, Rgb(2)), 1},
                        {"one texel", oneTexel, -1},
                        {"3x7", tall, -1}};
  for (const Case& c : cases) {
    const Probe probe(c.image);
    const double expected =
        c.expected >= 0 ? c.expected : 0.5 * irradianceOverPi(probe, {0, 1, 0}, 600);
    for (const std::string strategy : kStrategies) {
      const double mean = validMean(litPlane(probe, strategy, 64));
      const bool exact = strategy == "uniform" || strategy == "importance" || strategy == "bsdf" ||
                         strategy.starts_with("kollig-keller-strata");
      const double tolerance =
          exact ? 0.03 : 1;  // approximations are less accurate on unusual shapes
      EXPECT_NEAR(mean, expected, tolerance * expected) << c.name << ' ' << strategy;
    }
  }
}

TEST(SlowEnvelopeProbe, ASunAtThePolesAndOnTheSeam) {
  const int width = 64, height = 32;
  struct Case {
    const char* name;
    std::vector<glm::ivec2> texels;
    vec3 normal;
  };
  std::vector<glm::ivec2> zenith, nadir;
  for (int x = 0; x < width; ++x) zenith.push_back({x, 0}), nadir.push_back({x, height - 1});
  const Case cases[] = {{"zenith", zenith, {0, 1, 0}},
                        {"nadir", nadir, {0, -1, 0}},
                        {"beside the zenith", {{17, 0}}, {0, 1, 0}},
                        {"beside the nadir", {{0, height - 1}}, {0, -1, 0}},
                        {"on the seam", {{0, 15}, {width - 1, 15}}, {0, 0, 1}},
                        {"beside the seam", {{0, 15}}, {0, 0, 1}}};
  for (const Case& c : cases) {
    Image image = constantProbe({width, height}, Rgb(0));
    for (const glm::ivec2& t : c.texels) image.setRgb(t.x, t.y, Rgb(1000));
    const Probe probe(image);
    const double expected = 0.5 * irradianceOverPi(probe, c.normal, 2000);
    Scene scene;
    const vec3 across = std::fabs(c.normal.y) > 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 along = glm::cross(c.normal, across);
    addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), -across - along, 2.0f * across,
            2.0f * along);
    const Camera camera = Camera::lookAt(3.0f * c.normal, vec3(0), across, 0.3f);
    for (const char* strategy : {"importance", "suns", "uniform"}) {
      const bool coarse = std::string(strategy) == "uniform";
      const double mean = validMean(
          renderScene(scene, camera, probe, strategy, smallRender(16, 16, coarse ? 1024 : 128, 1)));
      // `suns` replaces sources by discs of another shape.
      EXPECT_NEAR(mean / expected, 1, std::string(strategy) == "importance" ? 3e-3 : 0.1)
          << c.name << ' ' << strategy;
    }
  }
}

TEST(EnvelopeProbe, HalfFloatInfinitiesAreRepairedAndReported) {
  Image image = constantProbe({16, 8}, Rgb(1));
  image.setRgb(3, 2, Rgb(65504));
  image.setRgb(4, 2, Rgb(INFINITY, 1, 1));
  image.setRgb(9, 5, Rgb(NAN));
  image.setRgb(2, 7, Rgb(1, -INFINITY, 1));
  const RepairReport report = repair(image, true);
  EXPECT_EQ(report.infinite, 2);
  EXPECT_EQ(report.nan, 1);
  EXPECT_EQ(image.rgb(4, 2), Rgb(65504, 1, 1));
  EXPECT_EQ(image.rgb(9, 5), Rgb(1));
  EXPECT_EQ(image.rgb(2, 7), Rgb(1, 0, 1));
  validMean(litPlane(Probe(image), "importance", 16));
}

TEST(EnvelopeProbe, ScalesBeyondTheRangeOfFloatAreRejected) {
  const Image bright = constantProbe({4, 2}, Rgb(1e30f));
  EXPECT_THROW(Probe(bright, 0, Rgb(1e10f)), InputError);
  EXPECT_THROW(Probe(bright, NAN), InputError);
  EXPECT_THROW(Probe(bright, 0, Rgb(-1)), InputError);
}

}  // namespace
}  // namespace chromeball::envelope_probe_test
