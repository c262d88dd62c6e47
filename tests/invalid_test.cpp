// SPDX-License-Identifier: Apache-2.0
// Invalid samples and clamped samples: what is discarded is counted.
#include <gtest/gtest.h>

#include <array>
#include <atomic>

#include "measure/statistics.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::invalid_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = INFINITY;

// Counts the samples of each pixel.
class Counter {
 public:
  int next(const CameraSample& sample) const {
    return seen_[size_t(sample.pixel->y * 9 + sample.pixel->x)]++;
  }

 private:
  mutable std::array<std::atomic<int>, 64> seen_{};
};

// Radiance 1, except for every second sample of a few pixels, which is invalid.
class Faulty : public SingleIntegrator {
 public:
  Sample sample(const CameraSample& camera, PathContext&) const override {
    const bool second = counter_.next(camera) % 2 == 1;
    const auto at = [&](int x, int y) {
      return camera.pixel->x == x && camera.pixel->y == y && second;
    };
    if (at(5, 2)) return Rgb(1, kNan, kInf);
    if (at(1, 3)) return Rgb(1, kInf, -1);
    if (at(7, 3)) return Rgb(1, 1, -0.5f);
    if (at(0, 4)) return Rgb(1, -kInf, 1);
    return Rgb(1);
  }

 private:
  Counter counter_;
};

RenderResult renderWith(const Integrator& integrator, RenderSettings settings) {
  const Scene scene;
  const World world(scene);
  const std::atomic<bool> stop = false;
  return render(
      integrator, world, Camera(), settings, [](double) {}, stop);
}

TEST(InvalidSamples, AreCountedByCauseAndPixelAndDiscarded) {
  RenderSettings settings = smallRender(9, 6, 8, 1);
  settings.aovs = {Aov::Invalid};
  const RenderResult r = renderWith(Faulty(), settings);
  EXPECT_EQ(r.invalid.of(Defect::Nan), 4u);
  EXPECT_EQ(r.invalid.of(Defect::Infinite), 8u);
  EXPECT_EQ(r.invalid.of(Defect::Negative), 4u);
  EXPECT_EQ(r.invalid.total(), 16u);
  EXPECT_EQ(std::pair(r.invalid.x, r.invalid.y), std::pair(5, 2));  // the first in scanline order

  const Image counts = r.aovs.finished(Aov::Invalid), mean = r.film.mean();
  const Image samples = r.film.sampleCounts();
  Rgb sum(0);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 9; ++x) {
      sum += counts.rgb(x, y);
      EXPECT_EQ(mean.rgb(x, y), Rgb(1)) << x << ' ' << y;
      EXPECT_EQ(*samples.at(x, y),
                8 - counts.rgb(x, y).x - counts.rgb(x, y).y - counts.rgb(x, y).z);
    }
  EXPECT_EQ(sum, Rgb(4, 8, 4));
  EXPECT_EQ(counts.rgb(5, 2), Rgb(4, 0, 0));
  EXPECT_EQ(counts.rgb(1, 3), Rgb(0, 4, 0));
  EXPECT_EQ(counts.rgb(7, 3), Rgb(0, 0, 4));
  EXPECT_EQ(counts.rgb(0, 4), Rgb(0, 4, 0));
}

class Firefly : public SingleIntegrator {
 public:
  Sample sample(const CameraSample& camera, PathContext& context) const override {
    return context.clamp(counter_.next(camera) % 2 == 0 ? Rgb(20, 10, 0) : Rgb(1));
  }

 private:
  Counter counter_;
};

TEST(Clamp, IsOffByDefaultAndReportsTheLoss) {
  RenderSettings settings = smallRender(3, 2, 4, 1);
  RenderResult r = renderWith(Firefly(), settings);
  const double bright = luminance(Rgb(20, 10, 0));
  EXPECT_EQ(r.clamped.count, 0u);
  EXPECT_EQ(r.clamped.fractionRemoved(), 0);
  EXPECT_NEAR(luminance(r.film.mean().rgb(0, 0)), 0.5 * (1 + bright),
              1e-5);  // 2 blocks of 2 samples

  settings.clamp = 4.0f;
  r = renderWith(Firefly(), settings);
  EXPECT_EQ(r.clamped.count, 12u);
  EXPECT_NEAR(r.clamped.fractionRemoved(), bright * 0.8 / (1 + bright), 1e-6);
  const Rgb clamped = r.film.mean().rgb(0, 0);
  EXPECT_NEAR(clamped.x, 0.5 * (1 + 4), 1e-6);  // preserves the hue
  EXPECT_NEAR(clamped.y, 0.5 * (1 + 2), 1e-6);

  settings.clamp = 20.0f;
  EXPECT_EQ(renderWith(Firefly(), settings).clamped.count, 0u);
}

TEST(Clamp, LimitsDifferencesOfBothSignsAndKeepsInvalidOnes) {
  Clamp clamp(2.0f);
  EXPECT_EQ(clamp(Rgb(-8, 4, 0)), Rgb(-2, 1, 0));
  EXPECT_EQ(clamp.clamped().count, 1u);
  EXPECT_EQ(clamp(Rgb(kInf, 1, 1)).x, kInf);
  EXPECT_TRUE(std::isnan(clamp(Rgb(1, kNan, 9)).y));
  EXPECT_EQ(clamp.clamped().count, 1u);
}

// For a NaN direction, the probe returns NaN without reading memory outside the map.
TEST(InvalidSamples, AProbeReturnsNanForNanDirections) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  const Rgb radiance = probe.radiance(vec3(kNan));
  EXPECT_TRUE(std::isnan(radiance.x));
}

}  // namespace
}  // namespace chromeball::invalid_test
