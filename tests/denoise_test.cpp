// SPDX-License-Identifier: Apache-2.0
// The denoiser: it removes noise, keeps details that are exact or explained by features, and knows
// its error.
#include "denoise/denoise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "denoise/planes.h"
#include "denoise/regression.h"
#include "denoise/selection.h"
#include "math/sampler.h"
#include "measure/image_error.h"
#include "render/render.h"
#include "small_scenes.h"

namespace chromeball::denoise_test {
namespace {

constexpr int kWidth = 75, kHeight = 50;  // neither is a multiple of a tile or a vector

float random(uint64_t i, uint64_t purpose) { return toUnit(uint32_t(hash(i, purpose))); }

// Approximately normal, with variance 1.
float gauss(uint64_t i, uint64_t purpose) {
  float sum = -6;
  for (uint64_t k = 0; k < 12; ++k) sum += random(i, 100 * purpose + k);
  return sum;
}

HalvedImage exact(int channels, float value = 0) {
  HalvedImage image{Image(kWidth, kHeight, channels), Image(kWidth, kHeight, channels)};
  std::fill(image.mean.texels.begin(), image.mean.texels.end(), value);
  return image;
}

// An image seen through independent noise of standard error `sigma` times the radiance; the
// features are constant.
template <class Radiance>
DenoiseInput noisy(float sigma, const Radiance& radiance) {
  DenoiseInput input{{exact(3)}, exact(3, 0.5f), exact(3, 1), exact(1, 0.1f)};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const auto i = uint64_t((y * kWidth + x) * 3 + c);
        const float value = radiance(x, y);
        // The mean of two halves, each of variance 2 sigma^2.
        const float a = value * sigma * 1.41421356f * gauss(i, 1);
        const float b = value * sigma * 1.41421356f * gauss(i, 2);
        input.parts[0].mean.at(x, y)[c] = value + (a + b) / 2;
        input.parts[0].half.at(x, y)[c] = (a - b) / 2;
      }
  return input;
}

Denoised run(const DenoiseInput& input) {
  const std::atomic<bool> never = false;
  return sumOf(*denoise(
      input, [](double) {}, never));
}

template <class Radiance>
double squaredError(const Image& image, const Radiance& radiance) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        const double difference = double(image.at(x, y)[c]) - double(radiance(x, y));
        sum += difference * difference;
      }
  return sum / (3 * kWidth * kHeight);
}

TEST(Denoise, AveragesAConstantImage) {
  const auto one = [](int, int) { return 1.0f; };
  const DenoiseInput input = noisy(0.3f, one);
  const Denoised denoised = run(input);
  EXPECT_LT(squaredError(denoised.color, one), squaredError(input.parts[0].mean, one) / 50);
  double mean = 0;
  for (const float texel : denoised.color.texels) mean += texel;
  mean /= double(denoised.color.texels.size());
  EXPECT_NEAR(mean, 1, 4 * 0.3 / std::sqrt(3.0 * kWidth * kHeight));
}

TEST(Denoise, KeepsAnExactImage) {
  const auto texture = [](int x, int y) { return 0.2f + random(uint64_t(y * kWidth + x), 7); };
  const DenoiseInput input = noisy(0, texture);
  const Denoised denoised = run(input);
  for (size_t i = 0; i < denoised.color.texels.size(); ++i)
    EXPECT_NEAR(denoised.color.texels[i], input.parts[0].mean.texels[i], 1e-5f);
  EXPECT_LT(remainingNoise(relativeErrors(denoised)), 1e-4);
}

// Details above the noise survive: the filter's error is known to exceed the noise there.
TEST(Denoise, KeepsDetailsAboveTheNoise) {
  const auto texture = [](int x, int y) { return 0.5f + random(uint64_t(y * kWidth + x), 7); };
  const DenoiseInput input = noisy(0.02f, texture);
  EXPECT_LT(squaredError(run(input).color, texture),
            1.1 * squaredError(input.parts[0].mean, texture));
}

// Where an object begins does not matter far away from there, whatever the tiles and vectors.
TEST(Denoise, TheEdgeOfAnObjectActsLocally) {
  const auto lines = [](int x, int y) { return unsigned(x - 66 - y / 8) < 2 ? 0.6f : 0.05f; };
  const auto errorFrom = [&](int left) {
    DenoiseInput input = noisy(0.4f, [&](int x, int y) { return x < left ? 0 : lines(x, y); });
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < left; ++x) {
        for (HalvedImage* image : {&input.albedo, &input.normal}) image->mean.setRgb(x, y, Rgb(0));
        *input.disparity.mean.at(x, y) = 0;
      }
    const Image found = run(input).color;
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 64; x < kWidth; ++x) {
        const double difference = double(found.at(x, y)[0]) - double(lines(x, y));
        sum += difference * difference;
      }
    return sum;
  };
  const double expected = errorFrom(32);
  for (int left = 33; left <= 40; ++left) EXPECT_NEAR(errorFrom(left) / expected, 1, 0.2) << left;
}

// A texture that is noise to the eye, but a feature explains it.
TEST(Denoise, KeepsWhatAFeatureExplains) {
  const auto albedo = [](int x, int y) { return random(uint64_t(y * kWidth + x), 7); };
  const auto radiance = [&](int x, int y) { return 0.2f + albedo(x, y); };
  DenoiseInput input = noisy(0.2f, radiance);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) input.albedo.mean.setRgb(x, y, Rgb(albedo(x, y)));
  EXPECT_LT(squaredError(run(input).color, radiance),
            squaredError(input.parts[0].mean, radiance) / 8);
}

// An edge that no feature shows stays sharp where the noise lets it be seen.
TEST(Denoise, KeepsAnEdge) {
  const auto shadow = [](int x, int) { return x < kWidth / 2 ? 0.1f : 1.0f; };
  const DenoiseInput input = noisy(0.2f, shadow);
  const Denoised denoised = run(input);
  EXPECT_LT(squaredError(denoised.color, shadow), squaredError(input.parts[0].mean, shadow) / 20);
  for (int y = 5; y < kHeight - 5; ++y) {
    EXPECT_LT(denoised.color.at(kWidth / 2 - 1, y)[1], 0.2f);
    EXPECT_GT(denoised.color.at(kWidth / 2, y)[1], 0.8f);
  }
}

TEST(Denoise, KnowsItsError) {
  const auto wave = [](int x, int y) {
    return 2 + std::sin(0.3f * float(x)) * std::cos(0.2f * float(y));
  };
  for (const float sigma : {0.02f, 0.1f, 0.5f}) {
    const Denoised denoised = run(noisy(sigma, wave));
    double estimate = 0;
    for (const float error : denoised.error.texels) estimate += double(error) * double(error);
    estimate /= kWidth * kHeight;
    const double truth = squaredError(denoised.color, wave);
    EXPECT_GT(estimate, truth / 2) << sigma;  // channels' errors are independent here, and the
    EXPECT_LT(estimate, truth * 3) << sigma;  // estimate assumes that they are not
  }
}

TEST(Denoise, ScalesWithTheRadiance) {
  const auto ramp = [](int x, int) { return 1 + 0.05f * float(x); };
  const DenoiseInput input = noisy(0.2f, ramp);
  const Denoised expected = run(input);
  for (const float scale : {0x1p-100f, 0x1p-30f, 0x1p-3f, 0x1p35f, 0x1p100f}) {
    DenoiseInput scaled = input;
    for (Image* image : {&scaled.parts[0].mean, &scaled.parts[0].half})
      for (float& texel : image->texels) texel *= scale;
    const Denoised found = run(scaled);
    for (size_t i = 0; i < found.color.texels.size(); ++i)
      ASSERT_EQ(found.color.texels[i], expected.color.texels[i] * scale);
    for (size_t i = 0; i < found.error.texels.size(); ++i)
      ASSERT_EQ(found.error.texels[i], expected.error.texels[i] * scale);
  }
}

TEST(Denoise, DoesNotDependOnTheUnitOfLength) {
  const auto disparity = [](int x, int y) {
    return 0.2f + 0.1f * random(uint64_t(y * kWidth + x), 7);
  };
  DenoiseInput input = noisy(0.2f, disparity);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      *input.disparity.mean.at(x, y) = disparity(x, y);
      *input.disparity.half.at(x, y) = 0.02f * gauss(uint64_t(y * kWidth + x), 8);
    }
  const Denoised expected = run(input);
  for (Image* image : {&input.disparity.mean, &input.disparity.half})
    for (float& texel : image->texels) texel *= 0x1p-30f;
  EXPECT_EQ(run(input).color.texels, expected.color.texels);
}

TEST(Denoise, BearsRadiancesFromTinyToHuge) {
  const auto extreme = [](int x, int y) {
    return std::pow(10.0f, 18 * random(uint64_t(y / 5 * kWidth + x / 5), 9) - 8);
  };
  DenoiseInput input = noisy(0.5f, extreme);
  const auto i = size_t(20 * kWidth + 30);
  input.parts[0].mean.texels[3 * i] = 0;
  for (Image* feature : {&input.normal.mean, &input.disparity.mean})
    for (size_t k = 0; k < feature->texels.size(); k += 7) feature->texels[k] = 1e10f;
  const Denoised denoised = run(input);
  for (const float texel : denoised.color.texels) {
    ASSERT_TRUE(std::isfinite(texel));
    ASSERT_GE(texel, 0);
  }
  for (const float error : denoised.error.texels) ASSERT_TRUE(std::isfinite(error) && error >= 0);
}

TEST(Denoise, AcceptsAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {3, 2}, {40, 1}, {33, 33}}) {
    const auto image = [&](int channels) {
      HalvedImage halved{Image(width, height, channels), Image(width, height, channels)};
      for (size_t i = 0; i < halved.mean.texels.size(); ++i) {
        halved.mean.texels[i] = 1 + random(i, 3);
        halved.half.texels[i] = 0.1f * gauss(i, 4);
      }
      return halved;
    };
    const DenoiseInput input{{image(3), image(3)}, image(3), image(3), image(1)};
    const Denoised denoised = run(input);
    EXPECT_EQ(denoised.color.texels.size(), input.parts[0].mean.texels.size());
    for (const float texel : denoised.color.texels) EXPECT_TRUE(std::isfinite(texel));
  }
}

TEST(Denoise, DoesNotDependOnThreads) {
  const DenoiseInput input = noisy(0.3f, [](int x, int) { return 1 + 0.05f * float(x); });
  const auto with = [&](size_t threads) {
    const ThreadLimit limit(threads);
    return run(input);
  };
  const Denoised one = with(1), three = with(3);
  EXPECT_EQ(one.color.texels, three.color.texels);
  EXPECT_EQ(one.error.texels, three.error.texels);
}

TEST(Denoise, StopsAtOnce) {
  const std::atomic<bool> stop = true;
  const DenoiseInput input = noisy(0.3f, [](int, int) { return 1.0f; });
  EXPECT_FALSE(denoise(
      input, [](double) {}, stop));
}

// A pixel without a hit and without light stays black beside bright noise.
TEST(Denoise, KeepsAnEmptyBackground) {
  const auto half = [](int x, int) { return x < kWidth / 2 ? 0.0f : 1.0f; };
  DenoiseInput input = noisy(0.5f, half);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) *input.disparity.mean.at(x, y) = 0;
  const Denoised denoised = run(input);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) {
      ASSERT_EQ(denoised.color.rgb(x, y), Rgb(0));
      ASSERT_EQ(*denoised.error.at(x, y), 0);
    }
  EXPECT_TRUE(
      std::isnan(remainingNoise(relativeErrors(run(noisy(0, [](int, int) { return 0.0f; }))))));
}

// A rare bright path in one half of the samples makes no bright spot; where such paths are
// frequent, their light stays.
TEST(Denoise, LimitsFireflies) {
  const auto one = [](int, int) { return 1.0f; };
  DenoiseInput input = noisy(0.1f, one);
  HalvedImage& color = input.parts[0];
  const auto addFirefly = [&](int x, int y, float radiance, float sign) {
    color.mean.setRgb(x, y, color.mean.rgb(x, y) + radiance / 2);
    color.half.setRgb(x, y, color.half.rgb(x, y) + sign * radiance / 2);
  };
  addFirefly(40, 25, 10000, 1);
  for (const float channel : {run(input).color.at(38, 24)[0], run(input).color.at(40, 25)[0]})
    EXPECT_NEAR(channel, 1, 0.1);

  double added = 0;
  for (int y = 1; y < kHeight; y += 2)
    for (int x = 1; x < kWidth; x += 2) {
      const float radiance = 40 * random(uint64_t(y * kWidth + x), 11);
      addFirefly(x, y, radiance, (x + y) % 4 ? 1 : -1);
      added += radiance / 2;
    }
  input.parts[0].mean.setRgb(40, 25, Rgb(1));
  input.parts[0].half.setRgb(40, 25, Rgb(0));
  double found = 0;
  const Denoised denoised = run(input);
  for (size_t i = 0; i < denoised.color.texels.size(); i += 3)
    found += denoised.color.texels[i] - 1;
  EXPECT_NEAR(found / added, 1, 0.1);
}

// The same holds where a bright object is in the filter's window: the dark pixels between both stay
// dark.
TEST(Denoise, LimitsFirefliesBesideBrightPixels) {
  DenoiseInput input = noisy(0.02f, [](int x, int) { return x < kWidth / 2 ? 0.2f : 8.0f; });
  HalvedImage& color = input.parts[0];
  for (int y = 4; y < kHeight; y += 9) {
    const int x = kWidth / 2 - 4;
    color.mean.setRgb(x, y, color.mean.rgb(x, y) + 15.0f);
    color.half.setRgb(x, y, color.half.rgb(x, y) + (y % 2 ? 15.0f : -15.0f));
  }
  const Denoised denoised = run(input);
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2 - 10; x < kWidth / 2 - 1; ++x)
      EXPECT_NEAR(denoised.color.at(x, y)[1], 0.2f, 0.2f) << x << " " << y;
}

// The light that the limit of fireflies removes is no error of pixels around them that have no
// noise.
TEST(Denoise, LostFirefliesLeaveTheErrorOfCleanPixels) {
  const auto edge = [](int x, int) { return x < kWidth / 2 ? 0.01f : 1.0f; };
  DenoiseInput input = noisy(0, edge);
  HalvedImage& color = input.parts[0];
  for (const auto& [y, sign] : {std::pair{10, 1.0f}, {35, -1.0f}})  // of either half
    for (const int x : {kWidth / 2 + 1, kWidth / 2 + 5}) {
      color.mean.setRgb(x, y, color.mean.rgb(x, y) + 300.0f);
      color.half.setRgb(x, y, color.half.rgb(x, y) + sign * 300.0f);
    }
  const Denoised denoised = run(input);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2 - 15; ++x) ASSERT_LT(*denoised.error.at(x, y), 1e-4f);
  double before = 0;
  for (size_t i = 0; i < color.half.texels.size(); i += 3)
    before += color.half.texels[i] * color.half.texels[i] / (kWidth * kHeight);
  EXPECT_LT(remainingNoise(relativeErrors(denoised)), std::sqrt(before));
}

// Errors of bright pixels do not spread to dark ones, nor relative errors of dark ones to bright
// ones.
TEST(Denoise, KnowsItsErrorBesideAnEdge) {
  const auto edge = [](int x, int) { return x < kWidth / 2 ? 0.01f : 1.0f; };
  DenoiseInput input = noisy(0.1f, edge);
  for (const auto& [x, y] : {std::pair{5, 20}, {kWidth / 2 - 3, 20}})  // dark fireflies
    for (Image* image : {&input.parts[0].mean, &input.parts[0].half})
      image->setRgb(x, y, Rgb(0.5f));
  const Denoised denoised = run(input);
  for (int y = 0; y < kHeight; ++y)
    for (int x = kWidth / 2 + 1; x < kWidth; ++x) EXPECT_LT(*denoised.error.at(x, y), 0.15f);
  for (int x = 15; x < kWidth / 2 - 12; ++x) EXPECT_LT(*denoised.error.at(x, 20), 0.003f);
}

// An average keeps a dark line to which a regression brings light, though it leaves more noise in
// the bright pixels around it.
TEST(Denoise, TheErrorOfADarkLineDecides) {
  constexpr int kLine = kHeight / 2;
  const auto candidate = [](FilterKind filter, float dark, float darkError, float brightError) {
    const auto planes = [](float line, float others) {
      const Plane plane =
          makePlane(kWidth, kHeight, [&](int, int y) { return y == kLine ? line : others; });
      return RgbPlanes{plane, plane, plane};
    };
    const RgbPlanes error = planes(darkError, brightError);
    return Candidate{.color = planes(dark, 8), .error = error, .variance = error, .filter = filter};
  };
  const Candidate regression = candidate(FilterKind::Narrow, 0.55f, 0.09f, 0.02f),
                  average = candidate(FilterKind::Average, 0.25f, 0.002f, 0.7f),
                  none = candidate(FilterKind::None, 0.25f, 0.01f, 2.0f);
  const Selection found = best({regression, average, none});
  EXPECT_FLOAT_EQ(found.color[1].at(20, kLine), 0.25f);
  EXPECT_NEAR(found.error[1].at(20, kLine), 0.002f, 0.001f);
  EXPECT_NEAR(found.error[1].at(20, kLine + 12), 0.02f, 1e-4f);  // far from it: the regression
}

// The regression is exact for colors that are affine in the features.
TEST(Denoise, RegressionIsExactForAffineColors) {
  FeaturePlanes features;
  for (size_t i = 0; i < kFeatures; ++i) {
    features.values[i] = makePlane(kWidth, kHeight, [&](int x, int y) {
      return random(uint64_t(y * kWidth + x), i) * std::pow(10.0f, float(i) - 3);
    });
    features.ridges[i] = makePlane(kWidth, kHeight, [](int, int) { return 1e-16f; });
  }
  RgbPlanes color;
  for (size_t c = 0; c < 3; ++c)
    color[c] = makePlane(kWidth, kHeight, [&](int x, int y) {
      return float(c) + 2 * features.values[3].at(x, y) - 30 * features.values[2].at(x, y);
    });
  NoisyPlanes flat;
  for (int c = 0; c < 3; ++c) {
    flat.values.push_back(makePlane(kWidth, kHeight, [](int, int) { return 1.0f; }));
    flat.variances.push_back(makePlane(kWidth, kHeight, [](int, int) { return 1.0f; }));
  }
  TileWeights weights;
  const PixelArea tile{32, 0, TileWeights::kWidth, TileWeights::kHeight};
  weights.compute(flat, tile, {});
  Predictions predictions(kWidth, kHeight);
  addRegressions(weights, 1, color, features, tile, {}, predictions);
  for (int y = 0; y < TileWeights::kHeight; ++y)
    for (int x = 32; x < 64; ++x)
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(predictions.weighted[c].at(x, y) / predictions.weights.at(x, y),
                    color[c].at(x, y), 2e-3f);
}

TEST(Denoise, WeightsAreThoseOfTheDefinition) {
  NoisyPlanes guide;
  for (int c = 0; c < 3; ++c) {
    guide.values.push_back(makePlane(kWidth, kHeight, [&](int x, int y) {
      return random(uint64_t(y * kWidth + x), uint64_t(c));
    }));
    guide.variances.push_back(
        makePlane(kWidth, kHeight, [](int x, int y) { return 0.05f + 0.001f * float(x + y); }));
  }
  TileWeights weights;
  const int left = 64, top = 32;
  weights.compute(guide, {left, top, kWidth - left, kHeight - top}, {});
  forNeighbours([&](size_t neighbour, int dx, int dy) {
    for (const auto& [x, y] : {std::pair{64, 32}, {70, 40}, {74, 49}, {75, 40}, {70, 50}}) {
      double sum = 0;
      const bool inside = x < kWidth && y < kHeight && x + dx < kWidth && y + dy < kHeight;
      for (int v = y - 3; v <= y + 3; ++v)
        for (int u = x - 3; u <= x + 3; ++u)
          for (size_t c = 0; c < 3; ++c) {
            const double variance =
                double(guide.variances[c].at(u, v)) + double(guide.variances[c].at(u + dx, v + dy));
            const double difference =
                double(guide.values[c].at(u, v)) - double(guide.values[c].at(u + dx, v + dy));
            sum += (difference * difference - variance) / variance / (3 * 49);
          }
      const float found = weights[neighbour][size_t((y - top) * TileWeights::kWidth + (x - left))];
      EXPECT_NEAR(found, inside ? std::exp(-std::max(sum, 0.0)) : 0, 1e-5);
    }
  });
}

TEST(Denoise, ExponentialIsAccurate) {
  for (float x = 0; x < 39; x += 0.0137f)
    EXPECT_NEAR(expOfMinus(splat8(x))[5] / std::exp(-x), 1, 1e-5f) << x;
  EXPECT_EQ(expOfMinus(splat8(0))[0], 1);
  EXPECT_EQ(expOfMinus(splat8(1e30f))[0], 0);
}

// The layers that a render keeps for the denoiser.
struct Rendered {
  DenoiseInput input;
  Image mean;
};

Rendered renderScene(const NamedScene& named, uint32_t samples, int maxDepth = 8,
                     uint64_t seed = 0) {
  const Probe probe(named.probe);
  const World world(named.scene, {}, allTables());
  const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
  RenderSettings settings;
  settings.width = 96, settings.height = 72;
  settings.samples = samples;
  settings.maxDepth = maxDepth;
  settings.seed = seed;
  settings.denoise = true;
  const std::atomic<bool> never = false;
  const Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f);
  const RenderResult result = render(
      world, camera, *lighting, settings, [](double) {}, never);
  const FeatureFilm& f = result.features;
  const HalvedImage color{result.film.mean(), result.film.halfDifference()};
  return {{{f.direct(), color - f.direct()}, f.albedo(), f.normal(), f.disparity()}, color.mean};
}

TEST(SlowDenoise, ReducesTheErrorOfRenders) {
  for (const NamedScene& named : threeScenes()) {
    const Rendered noisy = renderScene(named, 32);
    const Image reference = renderScene(named, 1024, 8, 1).mean;
    const Denoised denoised = run(noisy.input);
    const double before = imageError(noisy.mean, reference, nullptr, nullptr).relMse;
    const double after = imageError(denoised.color, reference, nullptr, nullptr).relMse;
    EXPECT_LT(after, before / 2.5) << named.name;
    const double estimate = remainingNoise(relativeErrors(denoised));
    EXPECT_GT(estimate, 0.4 * std::sqrt(after)) << named.name;
    EXPECT_LT(estimate, 3 * std::sqrt(after)) << named.name;
  }
}

TEST(FeatureFilm, DirectLightIsThatOfOneBounce) {
  const std::vector<NamedScene> scenes = threeScenes();
  const NamedScene& scene = scenes[0];  // matte
  const Rendered all = renderScene(scene, 64), direct = renderScene(scene, 64, 1);
  double found = 0, expected = 0;
  for (size_t i = 0; i < direct.mean.texels.size(); ++i) {
    found += double(all.input.parts[0].mean.texels[i]);
    expected += double(direct.mean.texels[i]);
    EXPECT_LE(all.input.parts[0].mean.texels[i], all.mean.texels[i] * 1.0001f);
  }
  EXPECT_NEAR(found / expected, 1, 0.003);
}

TEST(FeatureFilm, HalvesEstimateTheVariance) {
  FeatureFilm film(1, 1, true);
  for (uint64_t i = 0; i < 4; ++i)
    film.add(0, 0, int(i % 2), {.hit = true, .depth = 4, .seen = Rgb(i < 2 ? 1.0f : 0.0f)},
             Rgb(float(i)));
  EXPECT_EQ(film.direct().mean.texels[0], 1.5f);
  EXPECT_EQ(film.direct().half.texels[0], -0.5f);  // (0 + 2) / 2 - (1 + 3) / 2, halved
  EXPECT_EQ(film.albedo().mean.texels[1], 0.5f);
  EXPECT_EQ(film.disparity().mean.texels[0], 0.25f);
  film.weigh(0.5);
  film.add(0, 0, 0, {}, Rgb(3));
  EXPECT_FLOAT_EQ(film.direct().mean.texels[0], (0.5f * 6 + 3) / 3);
}

}  // namespace
}  // namespace chromeball::denoise_test
