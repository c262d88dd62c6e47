// SPDX-License-Identifier: Apache-2.0
// The probe's radiance function and its importance sampling.
#include <gtest/gtest.h>

#include "lighting/importance.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "sphere_test.h"
#include "test_probes.h"

namespace chromeball::importance_test {
namespace {

TEST(Probe, interpolatesBetweenTexelCentres) {
  Image image(8, 4, 3);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) image.setRgb(x, y, Rgb(float(x + 8 * y), 1, 2));
  const Probe probe(image);
  const auto at = [&](double u, double v) {
    return probe.radiance(vec3(*uvToDirection(Mapping::LatLong, {u, v}))).x;
  };
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_NEAR(at((x + 0.5) / 8, (y + 0.5) / 4), x + 8 * y, 1e-4);
      if (x < 7) {
        EXPECT_NEAR(at((x + 1.0) / 8, (y + 0.5) / 4), x + 8 * y + 0.5, 1e-4);
      }
    }
  EXPECT_NEAR(at(0, 0.375), 8 + 3.5, 1e-4);  // the seam: between 8 and 15
  EXPECT_NEAR(at(0.3, 1e-7), 3.5, 1e-3);     // the poles: their rows' means
  EXPECT_NEAR(at(0.7, 1 - 1e-7), 24 + 3.5, 1e-3);
}

TEST(Probe, rotationIsCounterClockwiseSeenFromAbove) {
  const Image image = spot(64, 32, 32, 16, 1, 0);  // along -Z, a little right and down
  const vec3 feature(*uvToDirection(Mapping::LatLong, {32.5 / 64, 16.5 / 32}));
  for (float degrees : {0.0f, 90.0f, -30.0f, 725.0f}) {
    const float r = degrees * kPi / 180;
    const vec3 turned(feature.x * std::cos(r) + feature.z * std::sin(r), feature.y,
                      -feature.x * std::sin(r) + feature.z * std::cos(r));
    EXPECT_NEAR(Probe(image, degrees).radiance(turned).x, 1, 1e-3) << degrees;
  }
}

TEST(Probe, latLongReturnsTheImage) {
  const Image image = gradientProbe({16, 8}, Rgb(1, 2, 3), {0.3, 0.5, 0.1});
  const Probe probe(image, -450, Rgb(4));
  const Image copy = probe.latLong();
  ASSERT_EQ(copy.width, 16);
  ASSERT_EQ(copy.height, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_EQ(copy.rgb(x, y), 4.0f * image.rgb(x, y));
  EXPECT_EQ(probe.rotation().yaw(), -450);
}

TEST(Probe, locateInvertsDirectionEverywhere) {
  const Probe probe(constantProbe({512, 256}, Rgb(1)), 77);
  for (int i = 0; i < 200000; ++i) {
    Probe::Position p{};
    p.column = int(random1(i, 0) * 512);
    p.row = i % 3 ? int(random1(i, 1) * 257) : 256 * (i & 1);
    p.s = random1(i, 2);
    p.t = random1(i, 3);
    const vec3 d = probe.direction(p);
    ASSERT_NEAR(glm::length(d), 1, 1e-5);
    const Probe::Position q = probe.locate(d);
    const float dx = std::remainder(float(q.column - p.column) + q.s - p.s, 512.0f);
    ASSERT_NEAR(dx * p.sinTheta, 0, 2e-4) << p.row;
    const float scale = p.row == 0 || p.row == 256 ? 0.5f : 1;
    if (p.row == q.row) {
      ASSERT_NEAR((q.t - p.t) * scale, 0, 2e-4);
    }
  }
}

TEST(Probe, rejectsScalesThatLeaveTheRangeOfFloat) {
  EXPECT_THROW(Probe(constantProbe({2, 1}, Rgb(1e30f)), 0, Rgb(1e20f)), std::runtime_error);
  EXPECT_THROW(Probe(constantProbe({2, 1}, Rgb(1)), 0, Rgb(1, -1, 1)), std::runtime_error);
  EXPECT_THROW(Probe(constantProbe({2, 1}, Rgb(1)), NAN), std::runtime_error);
}

// Several at once, through every probe, also tilted ones. Positions in the map differ by rounding,
// and radiance by that times the range of its cell.
TEST(Importance, LanesAreTheSameAsSingleDirections) {
  constexpr float kRounding = 1e-4f;
  const auto near = [](float lane, float single, float range) {
    return std::isnan(single) ? std::isnan(lane)
                              : std::fabs(lane - single) <= kRounding * (std::fabs(single) + range);
  };
  for (const HardProbe& c : hardProbes())
    for (const Rotation& rotation : {Rotation(33), Rotation::ofAngles({20, 30, 40})}) {
      SCOPED_TRACE(c.name);
      const Probe probe(c.image, rotation);
      const Importance importance(probe, true);
      const auto rangeAt = [&](const vec3& wi) {
        const Probe::Position p = probe.locate(wi);
        const Probe::Corners k = probe.corners(p.column, p.row);
        return maxComponent(glm::max(glm::max(k.c00, k.c10), glm::max(k.c01, k.c11)));
      };
      const LightPoint point{};
      for (uint64_t round = 0; round < 200; ++round) {
        std::array<glm::uvec2, LightSource::kMaxMany> numbers;
        std::array<DirectionSample, LightSource::kMaxMany> samples;
        std::array<LightSource::Escape, LightSource::kMaxMany> rays;
        std::array<LightSource::Escaped, LightSource::kMaxMany> found;
        const size_t count = 1 + round % numbers.size();
        for (size_t i = 0; i < count; ++i) {
          numbers[i] = {uint32_t(hash(round, i, uint64_t(0))),
                        uint32_t(hash(round, i, uint64_t(1)))};
          rays[i] = {&point, squareToUniformSphere(random2(int(round), int(i)))};
        }
        if (round % 8 == 0) rays[count / 2].wi.y = NAN;
        ASSERT_TRUE(importance.sampleMany(std::span(numbers).first(count),
                                          std::span(samples).first(count)));
        importance.escapedMany(std::span(rays).first(count), std::span(found).first(count));
        for (size_t i = 0; i < count; ++i) {
          const DirectionSample single =
              importance.sampleDirection(numbers[i].x * 0x1p-32, numbers[i].y * 0x1p-32);
          ASSERT_LT(glm::distance(samples[i].wi, single.wi), kRounding);
          ASSERT_NEAR(samples[i].pdf, single.pdf, 1e-3f * single.pdf);
          ASSERT_NEAR(samples[i].irradiance.x, single.irradiance.x, 1e-3f * single.irradiance.x);
          const LightSource::Escaped one = importance.escaped(point, rays[i].wi);
          const float range = rangeAt(rays[i].wi);
          for (int channel = 0; channel < 3; ++channel)
            ASSERT_PRED3(near, found[i].radiance[channel], one.radiance[channel], range);
          // The pdf has the range of the radiance times its ratio to that; more where compensation
          // leaves almost none of the radiance.
          constexpr float kLeastRange = 1e-2f / (4 * kPi);
          if (range > 0) {
            ASSERT_PRED3(near, found[i].pdf, one.pdf,
                         std::max(range * one.pdf / std::max(maxComponent(one.radiance), 1e-30f),
                                  kLeastRange));
          }
        }
      }
    }
}

TEST(SlowImportance, samplesFollowThePdfOnEveryProbe) {
  const std::vector<HardProbe> all = hardProbes();
  for (bool compensated : {false, true})
    for (const HardProbe& c : all) {
      SCOPED_TRACE(std::string(c.name) + (compensated ? ", compensated" : ""));
      const Probe probe(c.image, 33);
      const Importance importance(probe, compensated);
      const SphereTest test = testDirections(
          [&](int i) {
            return std::optional(
                importance.sampleDirection(double(random1(i, 0)), double(random1(i, 1))).wi);
          },
          [&](const vec3& w) { return importance.pdf(w); }, 200000, 3, 16, 32);
      EXPECT_NEAR(test.totalProbability, 1, 5e-3);
      EXPECT_GT(test.chiSquare.pValue, sidak(1e-3, 2 * int(all.size())));
    }
}

TEST(Importance, pdfOfSamplesAgreesWithPdfOfDirectionsAndIsPositiveWhereThereIsLight) {
  for (const HardProbe& c : hardProbes()) {
    SCOPED_TRACE(c.name);
    const Probe probe(c.image);
    const Importance importance(probe, false);
    for (int i = 0; i < 20000; ++i) {
      const DirectionSample s = importance.sampleDirection(random1(i, 0), random1(i, 1));
      ASSERT_GT(s.pdf, 0);
      ASSERT_NEAR(importance.pdf(s.wi), s.pdf, 2e-3f * s.pdf + 1e-3f);
      const vec3 w = squareToUniformSphere(random2(i, 2));
      if (luminance(probe.radiance(w)) > 0) {
        ASSERT_GT(importance.pdf(w), 0);
      }
    }
  }
}

// The pdf follows the radiance within texels too, so all samples of a grey probe have almost the
// same weight: the estimate of the mean radiance has almost no variance.
TEST(Importance, weightsAreConstantOnAGreyProbe) {
  Image image = constantProbe({512, 256}, Rgb(1));
  for (int i = 0; i < 512 * 256; ++i)
    image.setRgb(i % 512, i / 512, Rgb(random1(i, 0) < 0.1f ? 100 : 1));
  const Probe probe(image);
  const Importance importance(probe, false);
  double sum = 0, sumOfSquares = 0;
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i) {
    const DirectionSample s = importance.sampleDirection(random1(i, 1), random1(i, 2));
    const double weight = luminance(s.irradiance);
    sum += weight;
    sumOfSquares += weight * weight;
  }
  const double mean = sum / kSamples;
  EXPECT_LT(std::sqrt(sumOfSquares / kSamples - mean * mean) / mean, 0.02);
}

TEST(Importance, texelsAfterASunOf1e12KeepTheirProbability) {
  const Probe probe(spot(4096, 64, 1000, 20, 1e12f, 1));
  const Importance importance(probe, false);
  // Without the sun, the columns right of it must be as likely as those left of it.
  const vec3 left(*uvToDirection(Mapping::LatLong, {500.5 / 4096, 20.5 / 64}));
  const vec3 right(*uvToDirection(Mapping::LatLong, {3500.5 / 4096, 20.5 / 64}));
  EXPECT_GT(importance.pdf(left), 0);
  EXPECT_NEAR(importance.pdf(right) / importance.pdf(left), 1, 1e-3);
  const DirectionSample last = importance.sampleDirection(0x1.fffffffffp-1, 0.3);
  EXPECT_NEAR(luminance(last.irradiance), luminance(probe.radiance(right)) / importance.pdf(right),
              1e6);
}

TEST(Importance, blackProbesGiveNoSamples) {
  const Probe probe(constantProbe({8, 4}, Rgb(0)));
  const Importance importance(probe, true);
  EXPECT_EQ(importance.sampleDirection(0.3, 0.4).pdf, 0);
  EXPECT_EQ(importance.pdf(vec3(0, 1, 0)), 0);
}

TEST(Importance, compensationSubtractsTheMeanAndFallsBackOnAConstantProbe) {
  const Probe flat(constantProbe({32, 16}, Rgb(5)));
  EXPECT_NEAR(Importance(flat, true).pdf(vec3(0, 0, 1)), 0.25f * kInvPi, 1e-3);
  const Probe sun(spot(64, 32, 40, 9, 2000, 0.5f));
  const Importance compensated(sun, true);
  EXPECT_EQ(compensated.pdf(vec3(0, -1, 0)), 0);
  EXPECT_GT(compensated.pdf(vec3(*uvToDirection(Mapping::LatLong, {40.5 / 64, 9.5 / 32}))), 10);
}

}  // namespace
}  // namespace chromeball::importance_test
