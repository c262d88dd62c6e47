// SPDX-License-Identifier: Apache-2.0
// Adaptive sampling: unbiased, since a pixel's number of samples does not depend on its own
// samples; and more accurate at the same mean number.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "film/noise.h"
#include "measure/statistics.h"
#include "probe/synth.h"
#include "render/render.h"
#include "small_scenes.h"

namespace chromeball::adaptive_test {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr uint32_t kPilot = 8, kMean = 64;

// A pilot render whose pixels have random luminances, and a random variance around 1, or 16 in the
// right half.
PixelErrors randomPilot() {
  PixelErrors pilot{kWidth, kHeight, {}, {}, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const double u = double(uint32_t(hash(uint64_t(i)))) * 0x1p-32;
    const double variance = (0.5 + u) * (i % kWidth < kWidth / 2 ? 1 : 16);
    pilot.luminances.push_back(1);
    pilot.scatter.emplace_back(variance);
    pilot.halves.emplace_back(variance);
  }
  return pilot;
}

double meanCount(const SampleAllocation& allocation, int left, int right, uint32_t mean = kMean) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = left; x < right; ++x) sum += allocation.count(x, y, mean);
  return sum / ((right - left) * kHeight);
}

TEST(Allocation, IsProportionalToTheStandardErrorAndKeepsTheMean) {
  const SampleAllocation allocation(randomPilot(), kPilot);
  const double all = meanCount(allocation, 0, kWidth);
  EXPECT_NEAR(all, kMean, 0.01 * kMean);
  const double smooth = meanCount(allocation, 0, kWidth / 2 - 3) - kPilot;
  const double noisy = meanCount(allocation, kWidth / 2 + 3, kWidth) - kPilot;
  EXPECT_NEAR(noisy / smooth, 4, 0.2);
}

TEST(Allocation, NeverTakesBackASample) {
  const SampleAllocation allocation(randomPilot(), kPilot);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      uint32_t before = 0;
      for (uint32_t mean = 1; mean < 100; ++mean) {
        const uint32_t count = allocation.count(x, y, mean);
        EXPECT_GE(count, before);
        if (mean <= kPilot) {
          EXPECT_EQ(count, mean);
        }
        before = count;
      }
    }
  EXPECT_GE(allocation.count(0, 0, 4'000'000'000u), 4'000'000'000u / 100);  // no overflow
}

// A firefly in a pixel changes the numbers of its neighbours, but not its own.
TEST(Allocation, IgnoresThePixelItself) {
  const PixelErrors pilot = randomPilot();
  const SampleAllocation before(pilot, kPilot);
  int changed = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      PixelErrors other = pilot;
      const size_t i = size_t(y * kWidth + x);
      other.luminances[i] *= 1e3;
      other.scatter[i] *= 1e9;
      const SampleAllocation after(other, kPilot);
      EXPECT_EQ(after.count(x, y, kMean), before.count(x, y, kMean)) << x << ", " << y;
      const int neighbor = x > 0 ? x - 1 : x + 1;
      changed += after.count(neighbor, y, kMean) != before.count(neighbor, y, kMean);
    }
  EXPECT_GT(changed, kWidth * kHeight * 9 / 10);
}

TEST(Allocation, IsUniformWithoutNoise) {
  PixelErrors pilot = randomPilot();
  const auto expectUniform = [&] {
    const SampleAllocation allocation(pilot, kPilot);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) EXPECT_EQ(allocation.count(x, y, kMean), kMean);
  };
  pilot.scatter.assign(pilot.scatter.size(), glm::dvec4(0));
  expectUniform();
  pilot.scatter.assign(pilot.scatter.size(), glm::dvec4(std::nan("")));
  expectUniform();
  pilot.scatter.assign(pilot.scatter.size(), glm::dvec4(INFINITY));
  expectUniform();
}

// Radiance `kPeriod` in one of kPeriod samples on average, else 0: the pilot meets it in few
// pixels.
class RareLight : public SingleIntegrator {
 public:
  static constexpr uint64_t kPeriod = 50;
  Sample sample(const CameraSample&, PathContext& context) const override {
    return Rgb(hash(context.sampler.sampleKey(), 1) % kPeriod == 0 ? float(kPeriod) : 0);
  }
};

RenderSettings adaptiveRender(int width, int height, uint32_t samples, uint64_t seed = 0) {
  RenderSettings settings = smallRender(width, height, samples, 6, seed);
  settings.adaptive = true;
  return settings;
}

// Pixels that met the light early would be too bright if they then took other numbers of samples
// than those that did not.
TEST(SlowAdaptive, RareLightIsUnbiased) {
  const Scene scene;
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  Moments moments;
  std::vector<double> means;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    const RenderResult r = render(
        RareLight(), world, Camera(), adaptiveRender(64, 64, 32, seed), [](double) {}, stop);
    EXPECT_TRUE(r.adaptive);
    means.push_back(meanColor(r.film.mean()).x);
  }
  moments = Moments::of(means);
  const double error = std::sqrt(moments.variance / double(means.size()));
  EXPECT_LT(error, 0.004);
  EXPECT_LT(std::fabs(moments.mean - 1), 4 * error);
}

// Every pixel's mean over seeds agrees with the plain render's.
TEST(SlowAdaptive, AgreesWithThePlainRenderInEveryPixel) {
  constexpr int kSeeds = 24, kSize = 24;
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  for (NamedScene& named : threeScenes()) {
    const Probe probe(named.probe, 25);
    std::vector<std::vector<double>> plain(kSize * kSize), adaptive(kSize * kSize);
    double smallest = 1e9, largest = 0;
    for (uint64_t seed = 0; seed < 2 * kSeeds; ++seed) {
      RenderSettings settings = adaptiveRender(kSize, kSize, 64, seed);
      settings.adaptive = seed % 2;
      const RenderResult r = renderScene(named.scene, camera, probe, "importance", settings);
      const Image mean = r.film.mean(), counts = r.film.sampleCounts();
      for (int i = 0; i < kSize * kSize; ++i) {
        (settings.adaptive ? adaptive : plain)[size_t(i)].push_back(
            luminance(mean.rgb(i % kSize, i / kSize)));
        if (!settings.adaptive) continue;
        smallest = std::min(smallest, double(counts.texels[size_t(i)]));
        largest = std::max(largest, double(counts.texels[size_t(i)]));
      }
    }
    EXPECT_LT(smallest, 32) << named.name;
    EXPECT_GT(largest, 96) << named.name;
    double lowest = 1;
    for (int i = 0; i < kSize * kSize; ++i) {
      const Moments a = Moments::of(adaptive[size_t(i)]), b = Moments::of(plain[size_t(i)]);
      if (a.variance > 0 || b.variance > 0) lowest = std::min(lowest, welchTest(a, b));
    }
    EXPECT_GT(lowest, sidak(1e-3, kSize * kSize)) << named.name;
  }
}

TEST(SlowAdaptive, HasASmallerErrorAtTheSameMean) {
  constexpr int kSize = 64;
  const NamedScene named = std::move(threeScenes()[0]);
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(clearSkyProbe({64, 32}, {.sunElevation = 40}), 25);
  double squared[2] = {0, 0};
  for (uint64_t seed = 0; seed < 8; ++seed)
    for (const bool adaptive : {false, true}) {
      RenderSettings settings = adaptiveRender(kSize, kSize, 64, seed);
      settings.adaptive = adaptive;
      const RenderResult r = renderScene(named.scene, camera, probe, "importance", settings);
      EXPECT_EQ(r.samples, 64u);
      double total = 0;
      for (float count : r.film.sampleCounts().texels) total += count;
      EXPECT_NEAR(total / (kSize * kSize), 64, 0.64);
      squared[adaptive] += r.film.noise().noise * r.film.noise().noise;
    }
  EXPECT_LT(squared[1], 0.75 * squared[0]);
}

TEST(SlowAdaptive, TheNumberOfThreadsChangesNothing) {
  const NamedScene named = std::move(threeScenes()[1]);
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(named.probe);
  std::vector<Image> images;
  for (const size_t threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    const RenderResult r =
        renderScene(named.scene, camera, probe, "importance", adaptiveRender(50, 40, 20));
    EXPECT_TRUE(r.adaptive);
    images.push_back(r.film.mean());
  }
  EXPECT_EQ(images[0].texels, images[1].texels);
  EXPECT_EQ(images[0].texels, images[2].texels);
}

TEST(Adaptive, NeedsSixteenSamples) {
  const Scene scene;
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  for (const uint32_t samples : {1u, 4u, 15u, 16u, 17u}) {
    const RenderResult r = render(
        RareLight(), world, Camera(), adaptiveRender(32, 32, samples), [](double) {}, stop);
    EXPECT_EQ(r.samples, samples);
    EXPECT_EQ(r.adaptive, samples >= 16);
  }
}

// The left half of the picture is 1; on the right half one sample in two is 9, clamped to 3, the
// other 1, and each loses 5 to a depth limit.
class HalfNoisy : public SingleIntegrator {
 public:
  Sample sample(const CameraSample& camera, PathContext& context) const override {
    const bool isBright = camera.pixel->x >= 16 && hash(context.sampler.sampleKey(), 1) % 2 == 0;
    const Rgb found(isBright ? 9.0f : 1.0f);
    context.depthCut.addFound(found);
    if (camera.pixel->x >= 16) context.depthCut.add(DepthLimit::Depth, 5);
    return context.clamp(found);
  }
};

// Fractions of the light are those of the picture, not of the samples, of which the noisy half
// takes more; also for a shard that keeps none of the samples that all pixels take.
TEST(Adaptive, FractionsOfLightAreThoseOfThePicture) {
  const Scene scene;
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  RenderSettings settings = adaptiveRender(32, 32, 256);
  settings.clamp = 3.0f;
  for (const RenderSettings& s : {settings, shardOf(settings, 0, 2), shardOf(settings, 1, 2)}) {
    const RenderResult r = render(
        HalfNoisy(), world, Camera(), s, [](double) {}, stop);
    EXPECT_TRUE(r.adaptive);
    EXPECT_NEAR(r.clamped.fractionRemoved(), 1.5 / 3, 0.01);  // 0.25 * 6 of (1 + 5) / 2
    EXPECT_NEAR(r.depthCut.fraction(DepthLimit::Depth), 2.5 / 5.5, 0.01);
    EXPECT_GT(r.clamped.count, uint64_t(s.shard.count == 1 ? 32 * 32 * 64 * 1.2 : 32 * 32 * 32));
  }
}

// Where one pixel in a thousand is noisy, the limit of its rate leaves the rest of the samples
// untaken; the stated number is that of the samples in the film.
TEST(Adaptive, TheStatedNumberOfSamplesIsWhatPixelsTook) {
  class OneNoisyPixel : public SingleIntegrator {
    Sample sample(const CameraSample& camera, PathContext& context) const override {
      return Rgb(camera.pixel->x == 16 && camera.pixel->y == 16
                     ? hash(context.sampler.sampleKey(), 1) % 2
                     : 1);
    }
  };
  const Scene scene;
  const World world(scene, {}, allTables());
  const std::atomic<bool> stop = false;
  const RenderResult r = render(
      OneNoisyPixel(), world, Camera(), adaptiveRender(100, 100, 256), [](double) {}, stop);
  double sum = 0;
  const Image counts = r.film.sampleCounts();
  for (const float count : counts.texels) sum += count;
  EXPECT_LT(r.samplesPerPixel(), 200u);
  EXPECT_NEAR(r.samplesPerPixel(), sum / 10000, 0.5);
}

}  // namespace
}  // namespace chromeball::adaptive_test
