// SPDX-License-Identifier: Apache-2.0
// `noise` and the layer `variance` estimate each pixel's standard error: compared with the standard
// deviation over independent seeds.
#include <gtest/gtest.h>

#include <random>

#include "probe/load.h"
#include "probe/synth.h"
#include "shared_data.h"
#include "small_scenes.h"

namespace chromeball::noise_test {
namespace {

constexpr int kSeeds = 24;

struct Case {
  NamedScene named;
  const char* strategy;
};

// One of the three scenes, under its own probe or, if given, under `probe`.
Case caseOf(size_t index, const char* strategy, const char* name = nullptr, Image probe = {}) {
  Case c{std::move(threeScenes()[index]), strategy};
  if (!name) return c;
  c.named.name = name;
  c.named.probe = std::move(probe);
  return c;
}

Image clearSky() { return clearSkyProbe({64, 32}, {.sunElevation = 40}); }

std::vector<Case> eightCases() {
  std::vector<Case> cases;
  cases.push_back(caseOf(0, "importance"));
  cases.push_back(caseOf(1, "importance"));
  cases.push_back(caseOf(2, "importance"));
  cases.push_back(caseOf(1, "product"));
  cases.push_back(caseOf(0, "suns", "matte spheres under a sun", clearSky()));
  cases.push_back(caseOf(0, "uniform", "matte spheres in a studio", studioProbe({64, 32})));
  cases.push_back(caseOf(1, "bsdf", "metals and plastics under an overcast sky",
                         overcastProbe({32, 16}, Rgb(0.5f), 0.2)));
  cases.push_back(caseOf(1, "kollig-keller-strata:8", "metals and plastics under a gradient",
                         gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6})));
  return cases;
}

// A glass ball above the ground: all light in its shadow is a caustic.
Case glassBall() {
  Case c{{"a ball of glass under a sun", {}, clearSky()}, "importance"};
  Scene& s = c.named.scene;
  addQuad(s, addMaterial(s, lambert(Rgb(0.6f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  Material glass;
  glass.metallic = glass.roughness = 0;
  glass.extended.emplace();
  glass.extended->transmission = 1;
  glass.extended->thinWalled = false;
  addSphere(s, addMaterial(s, glass), {0, 0.7f, 0}, 0.6f, 32);
  return c;
}

// The inside of a room with a window of about 1/100 of the walls' area.
Case darkRoom() {
  Case c{{"a room with a small window", {}, clearSky()}, "importance"};
  Scene& s = c.named.scene;
  const int wall = addMaterial(s, lambert(Rgb(0.7f)));
  addQuad(s, wall, {-5, 0, 5}, {10, 0, 0}, {0, 0, -10});      // floor
  addQuad(s, wall, {-5, 4, -5}, {10, 0, 0}, {0, 0, 10});      // ceiling
  addQuad(s, wall, {-5, 0, -5}, {10, 0, 0}, {0, 4, 0});       // back
  addQuad(s, wall, {5, 0, 5}, {-10, 0, 0}, {0, 4, 0});        // front
  addQuad(s, wall, {-5, 0, 5}, {0, 0, -10}, {0, 4, 0});       // left
  addQuad(s, wall, {5, 0, -5}, {0, 0, 10}, {0, 1.5f, 0});     // right, below the window,
  addQuad(s, wall, {5, 2.5f, -5}, {0, 0, 10}, {0, 1.5f, 0});  // above it,
  addQuad(s, wall, {5, 1.5f, -5}, {0, 0, 4.5f}, {0, 1, 0});   // and beside
  addQuad(s, wall, {5, 1.5f, 0.5f}, {0, 0, 4.5f}, {0, 1, 0});
  return c;
}

struct Seed {
  Image mean, squaredError;
  double noise, upper;
  uint32_t samples;
};

std::vector<Seed> renderSeeds(const Case& c, RenderSettings settings) {
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const Probe probe(c.named.probe, 25);
  std::vector<Seed> seeds;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = uint64_t(seed);
    const RenderResult r = renderScene(c.named.scene, camera, probe, c.strategy, settings);
    const PixelErrors errors = r.film.errors();
    const Noise noise = estimateNoise(errors);
    seeds.push_back({r.film.mean(), varianceImage(errors), noise.noise, noise.upper, r.samples});
  }
  return seeds;
}

// `noise` computed from the variance of each pixel's luminance over the seeds.
double noiseOverSeeds(const std::vector<Seed>& seeds) {
  double meanLuminance = 0;
  std::vector<glm::dvec2> pixels;  // mean, variance
  const int width = seeds[0].mean.width, count = width * seeds[0].mean.height;
  for (int i = 0; i < count; ++i) {
    double sum = 0, sumOfSquares = 0;
    for (const Seed& seed : seeds) {
      const double y = luminance(seed.mean.rgb(i % width, i / width));
      sum += y;
      sumOfSquares += y * y;
    }
    const double mean = sum / kSeeds;
    pixels.emplace_back(mean, std::max(0.0, (sumOfSquares - sum * mean) / (kSeeds - 1)));
    meanLuminance += mean / count;
  }
  double squared = 0;
  for (const glm::dvec2& p : pixels) {
    const double reference = std::max(p.x, 0.01 * meanLuminance);
    squared += p.y / (reference * reference) / count;
  }
  return std::sqrt(squared);
}

// Fraction of the renders' values whose interval of +-z estimated standard errors contains the mean
// over the other seeds.
double coverage(const std::vector<Seed>& seeds, double z = 1.96) {
  size_t covered = 0, count = 0;
  for (size_t i = 0; i < seeds[0].mean.texels.size(); ++i) {
    double sum = 0;
    for (const Seed& seed : seeds) sum += seed.mean.texels[i];
    for (const Seed& seed : seeds) {
      const double others = (sum - seed.mean.texels[i]) / (kSeeds - 1);
      // The mean of the other seeds has an error too.
      const double error = std::sqrt(seed.squaredError.texels[i] * (1 + 1.0 / (kSeeds - 1)));
      covered += std::fabs(seed.mean.texels[i] - others) <= z * error;
      ++count;
    }
  }
  return double(covered) / double(count);
}

// Root mean square of the reported noise divided by noiseOverSeeds(). The square of the reported
// noise is the unbiased estimate.
double noiseRatio(const std::vector<Seed>& seeds) {
  double reported = 0;
  for (const Seed& seed : seeds) reported += seed.noise * seed.noise / kSeeds;
  return std::sqrt(reported) / noiseOverSeeds(seeds);
}

constexpr int kSize = 24;

// 65 samples divide into halves of different size.
TEST(SlowNoise, MatchesTheVarianceOverSeeds) {
  for (const Case& c : eightCases())
    for (const auto& [samples, adaptive] : {std::pair{16u, false}, {65u, false}, {64u, true}}) {
      SCOPED_TRACE(std::string(c.named.name) + ", " + c.strategy);
      RenderSettings settings = smallRender(kSize, kSize, samples, 6);
      settings.adaptive = adaptive;
      const std::vector<Seed> seeds = renderSeeds(c, settings);
      EXPECT_NEAR(noiseRatio(seeds), 1, 0.1);
      EXPECT_NEAR(coverage(seeds), 0.95, samples < 32 ? 0.035 : 0.02);
      EXPECT_GT(coverage(seeds, 3), 0.975);
    }
}

// A few pixels receive most of the light: the estimate is still correct on average over seeds, and
// the intervals of the other pixels are wide.
TEST(SlowNoise, MatchesTheVarianceOverSeedsWithRareLight) {
  constexpr int kLarge = 48;  // so that a window of 7 x 7 pixels covers one object
  std::vector<Case> cases;
  cases.push_back(caseOf(1, "importance", "metals and plastics under a sun", clearSky()));
  cases.push_back(glassBall());
  cases.push_back(caseOf(0, "median-cut:16", "matte spheres in a studio", studioProbe({64, 32})));
  cases.push_back(darkRoom());
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.named.name) + ", " + c.strategy);
    for (const bool adaptive : {false, true}) {
      RenderSettings settings = smallRender(kLarge, kLarge, 64, 6);
      settings.adaptive = adaptive;
      settings.guiding = Guiding::Off;
      const std::vector<Seed> seeds = renderSeeds(c, settings);
      EXPECT_NEAR(noiseRatio(seeds), 1, 0.12);
      if (&c == &cases.back()) continue;  // pixels that are still black have no error estimate
      // An adaptive render leaves pixels without noise so far at a quarter of the mean.
      EXPECT_NEAR(coverage(seeds), 0.95, adaptive ? 0.05 : 0.03);
      EXPECT_GT(coverage(seeds, 3), adaptive ? 0.94 : 0.955);
    }
  }
}

// Guided bounces leave few fireflies, which count for the pixels around them too.
TEST(SlowNoise, IsConservativeWithGuidedBounces) {
  RenderSettings settings = smallRender(48, 48, 64, 6);
  settings.guiding = Guiding::On;
  const double ratio = noiseRatio(renderSeeds(glassBall(), settings));
  EXPECT_GT(ratio, 0.9);
  EXPECT_LT(ratio, 2.2);
}

TEST(SlowNoise, IsConservativeOnMetalsUnderRealProbes) {
  for (const char* file : {"probes/debevec/grace_probe.hdr", "probes/debevec/stpeters_cross.hdr"}) {
    const auto path = sharedData(file);
    if (!path) GTEST_SKIP() << "no " << file << " here";
    const Case c = caseOf(1, "importance", file, loadProbe(path->string(), "auto", "test").latLong);
    const std::vector<Seed> seeds = renderSeeds(c, smallRender(48, 48, 32, 6));
    EXPECT_GT(noiseRatio(seeds), 0.9) << file;
    EXPECT_LT(noiseRatio(seeds), 1.3) << file;  // closer to 1 in larger images: 1.07 at 96 x 96
    EXPECT_NEAR(coverage(seeds), 0.95, 0.025) << file;
  }
}

// When the noise limit stops a render, the estimate is correct and few samples were superfluous.
TEST(SlowNoise, IsCorrectWhenItStopsTheRender) {
  constexpr double kLimit = 0.05;
  for (const Case& c :
       {caseOf(0, "importance"), caseOf(1, "importance"), caseOf(2, "importance")}) {
    SCOPED_TRACE(c.named.name);
    RenderSettings settings = smallRender(kSize, kSize, 1u << 13, 6);
    settings.noiseLimit = kLimit;
    settings.adaptive = true;
    const std::vector<Seed> seeds = renderSeeds(c, settings);
    for (const Seed& seed : seeds) EXPECT_LE(seed.upper, kLimit);
    EXPECT_NEAR(noiseRatio(seeds), 1, 0.1);
    EXPECT_LE(noiseOverSeeds(seeds), kLimit);
    EXPECT_GE(noiseOverSeeds(seeds), 0.65 * kLimit);
    EXPECT_NEAR(coverage(seeds), 0.95, 0.025);
  }
}

// Radiance `period` in one of `period` samples on average and 0 in the others; always 0 if `period`
// is 0.
class RareLight : public SingleIntegrator {
 public:
  explicit RareLight(uint64_t period) : period_(period) {}
  Sample sample(const CameraSample&, PathContext& context) const override {
    const bool meets = period_ > 0 && hash(context.sampler.sampleKey(), 1) % period_ == 0;
    return Rgb(meets ? float(period_) : 0);
  }

 private:
  uint64_t period_;
};

RenderResult renderRareLight(uint64_t period, RenderSettings settings) {
  const Scene scene;
  const World world(scene);
  const std::atomic<bool> stop = false;
  return render(
      RareLight(period), world, Camera(), settings, [](double) {}, stop);
}

TEST(SlowNoise, DoesNotStopARenderWithoutLightSoFar) {
  RenderSettings settings = smallRender(8, 8, 1u << 20, 1);
  settings.noiseLimit = 0.2;
  const RenderResult rare = renderRareLight(20000, settings);
  EXPECT_GT(rare.samples, 10000u);
  EXPECT_NEAR(meanColor(rare.film.mean()).x, 1, 0.2);
  const RenderResult none = renderRareLight(0, settings);  // stops in the end
  EXPECT_EQ(none.samples, 4096u);
  EXPECT_TRUE(std::isnan(none.film.noise().noise));
}

TEST(Noise, IsUnknownWithoutTwoSamplesNotZero) {
  const RenderResult one = renderRareLight(1, smallRender(4, 4, 1, 1));
  EXPECT_TRUE(std::isnan(one.film.noise().noise));
  for (float x : varianceImage(one.film.errors()).texels) EXPECT_TRUE(std::isnan(x));
  EXPECT_EQ(renderRareLight(1, smallRender(4, 4, 2, 1)).film.noise().noise, 0);  // equal samples
}

// The square of `noise` is unbiased, also for the smallest numbers of samples.
TEST(Noise, HasAnUnbiasedSquare) {
  constexpr int kPeriod = 4;
  for (const uint32_t samples : {2u, 3u, 5u, 16u}) {
    double squared = 0;
    constexpr int kRenders = 200;
    for (int seed = 0; seed < kRenders; ++seed) {
      const PixelErrors errors =
          renderRareLight(kPeriod, smallRender(8, 8, samples, 1, uint64_t(seed))).film.errors();
      for (const glm::dvec4& halves : errors.halves) squared += halves.w / (64 * kRenders);
    }
    // The variance of the mean of independent samples.
    const double expected = double(kPeriod - 1) / samples;
    EXPECT_NEAR(squared / expected, 1, 0.05) << samples;
  }
}

// The edge of a lamp must not be treated as rare light: the error of the pixels beside it is small.
TEST(Noise, EdgesOfLampsAreNotRareLight) {
  Scene scene;
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(10);
  addQuad(scene, addMaterial(scene, lamp), {-1, 0.3f, 0}, {2, 0.5f, 0}, {-0.2f, 1, 0});
  const Camera camera = Camera::lookAt({0, 1, 5}, {0, 1, 0}, {0, 1, 0}, 0.7f);
  const Probe dim(gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.3}));
  const PixelErrors errors =
      renderScene(scene, camera, dim, "importance", smallRender(64, 64, 64, 1)).film.errors();
  std::vector<float> relative = relativeErrors(errors, squaredStandardErrors(errors)).texels;
  const auto p95 = relative.begin() + ptrdiff_t(0.95 * double(relative.size()));
  std::ranges::nth_element(relative, p95);
  // If 5% of the pixels have the whole mean square, p95 / noise = 1 / sqrt(0.05) = 4.5; the bound
  // is twice that.
  EXPECT_LT(*p95, 9 * estimateNoise(errors).noise);
}

// A dim image in which every sample of the pixels within `radius` of the middle meets a bright
// light with a probability of `lights` / 32; 32 samples per pixel. Returns the ratio of the mean
// square of `noise` over many renders to its true value.
double noiseRatioOfHighlight(double radius, double lights) {
  constexpr int kSide = 32, kRenders = 60;
  constexpr uint32_t kSamples = 32;
  constexpr double kDim = 0.1, kBright = 20;
  const double probability = lights / kSamples;
  const auto isLit = [&](int x, int y) {
    return std::hypot(x - kSide / 2, y - kSide / 2) <= radius;
  };
  const double litLuminance = kDim / 2 + probability * kBright;
  double lit = 0;
  for (int i = 0; i < kSide * kSide; ++i) lit += isLit(i % kSide, i / kSide);
  const double share = lit / (kSide * kSide);
  const double mean = share * litLuminance + (1 - share) * kDim / 2;
  const double dimVariance = kDim * kDim / 12 / kSamples;  // of uniform numbers
  const double litVariance =
      dimVariance + probability * (1 - probability) * kBright * kBright / kSamples;
  const double dimReference = std::max(kDim / 2, 0.01 * mean);
  const double expected = share * litVariance / (litLuminance * litLuminance) +
                          (1 - share) * dimVariance / (dimReference * dimReference);
  double squared = 0;
  for (uint64_t render = 0; render < kRenders; ++render) {
    Film film(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        std::array<SampleSums, Film::kHalves> sums;
        for (uint64_t k = 0; k < kSamples; ++k) {
          const uint64_t key = hash(uint64_t(y * kSide + x), render * kSamples + k);
          const double dim = kDim * double(toUnit(uint32_t(hash(key, 1))));
          const bool meets = isLit(x, y) && double(toUnit(uint32_t(hash(key, 2)))) < probability;
          sums[k % 2].add(Rgb(float(dim + (meets ? kBright : 0))));
        }
        for (int half = 0; half < Film::kHalves; ++half) film.add(x, y, half, sums[size_t(half)]);
      }
    squared += std::pow(film.noise().noise, 2) / kRenders;
  }
  return squared / expected;
}

// A highlight counts with its own luminance, also where few samples make it up, and rare light with
// the luminance of its surroundings.
TEST(SlowNoise, KnowsHighlightsFromRareLight) {
  for (const double radius : {1.5, 3.0, 6.0})
    for (const double lights : {4.0, 10.0}) {
      const double ratio = noiseRatioOfHighlight(radius, lights);
      EXPECT_GT(ratio, 0.75) << radius << " " << lights;
      EXPECT_LT(ratio, 1.8) << radius << " " << lights;  // noise is at most a third too large
    }
  EXPECT_NEAR(std::sqrt(noiseRatioOfHighlight(100, 0.02)), 1, 0.25);
}

// A pixel without a valid sample has an unknown variance, which does not affect the others.
TEST(Noise, ToleratesPixelsWithoutAValidSample) {
  Film film(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      for (int half = 0; half < Film::kHalves; ++half) {
        SampleSums sums;
        if (x + y > 0) sums.add(Rgb(half == 0 ? 0.9f : 1.1f));
        film.add(x, y, half, sums);
      }
  EXPECT_NEAR(film.noise().noise, 0.1, 1e-3);
  const Image variance = varianceImage(film.errors());
  EXPECT_TRUE(std::isnan(variance.rgb(0, 0).x));
  EXPECT_NEAR(variance.rgb(1, 0).x, 0.01, 1e-5);
  const NoiseQuantiles quantiles =
      noiseQuantiles(relativeErrors(film.errors(), squaredStandardErrors(film.errors())));
  EXPECT_NEAR(quantiles.median, 0.1, 1e-3);
  EXPECT_NEAR(quantiles.p95, 0.1, 1e-3);
}

// A person asks how noisy the objects are: a plate or a black background, of any size, is not.
TEST(Noise, QuantilesLeaveOutPixelsWithoutNoise) {
  Image relative(10, 10, 1);
  for (size_t i = 90; i < 100; ++i) relative.texels[i] = 0.01f * float(i - 89);
  EXPECT_NEAR(noiseQuantiles(relative).median, 0.05, 1e-6);
  EXPECT_NEAR(noiseQuantiles(relative).p95, 0.09, 1e-6);
  EXPECT_EQ(noiseQuantiles(Image(4, 4, 1)).median, 0);
  for (size_t i = 0; i < 90; ++i) relative.texels[i] = 0.001f;  // a visible probe
  EXPECT_NEAR(noiseQuantiles(relative).median, 0.05, 1e-6);
  for (size_t i = 90; i < 100; ++i) relative.texels[i] = 0.0005f;  // all is clean
  EXPECT_NEAR(noiseQuantiles(relative).median, 0.001, 1e-6);
}

// Samples that are all equal have no error, however their sums round, also beside rare light.
TEST(Noise, IsZeroForEqualSamplesBesideRareLight) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.01f, 2);
  Film film(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const Rgb color(unit(random), unit(random), unit(random));
      const bool isRare = x % 5 == 2 && y % 5 == 2;
      for (int half = 0; half < Film::kHalves; ++half) {
        SampleSums sums;
        for (int k = 0; k < 50; ++k) sums.add(isRare && half == 0 && k == 0 ? Rgb(1e3f) : color);
        film.add(x, y, half, sums);
      }
    }
  const Image variance = varianceImage(film.errors());
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      if (x % 5 == 2 && y % 5 == 2) continue;
      EXPECT_EQ(variance.rgb(x, y), Rgb(0)) << x << ',' << y;
    }
}

}  // namespace
}  // namespace chromeball::noise_test
