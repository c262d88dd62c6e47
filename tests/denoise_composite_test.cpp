// SPDX-License-Identifier: Apache-2.0
// Denoised composites: less error in both modes, and the plate's bits where objects change nothing.
#include "composite/compose.h"

#include <gtest/gtest.h>

#include "composite/layers.h"
#include "measure/image_error.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::denoise_composite_test {
namespace {

constexpr int kWidth = 96, kHeight = 72;

const std::atomic<bool> never = false;

// A ball and a rough metal ball on a local floor, which ends before the image does.
struct TwoBalls {
  Scene scene;
  ObjectMask isObject{false, true, true};
  Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.4f, 0}, {0, 1, 0}, 0.7f);
  Probe probe{studioProbe({64, 32})};
  Image plate{kWidth, kHeight, 3};

  TwoBalls() {
    addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-2, 0, 2}, {4, 0, 0}, {0, 0, -3});
    addSphere(scene, addMaterial(scene, lambert({0.8f, 0.1f, 0.1f})), {-0.6f, 0.4f, 0}, 0.4f, 24);
    Material metal;
    metal.roughness = 0.4f;
    addSphere(scene, addMaterial(scene, metal), {0.6f, 0.5f, -0.4f}, 0.5f, 24);
    for (size_t i = 0; i < plate.texels.size(); ++i)  // so that rounding in any arithmetic shows
      plate.texels[i] = 1 + toUnit(uint32_t(hash(i)));
  }

  CompositeRender render(uint32_t samples, uint64_t seed = 0, Passes passes = Passes::One) const {
    const World world(scene, rayMasks(isObject), allTables());
    const auto lighting = makeStrategy("importance", probe, Mis::Balance, "test");
    RenderSettings settings = smallRender(kWidth, kHeight, samples, 5, seed);
    settings.denoise = true;
    return renderComposite(
        world, camera, *lighting, plate, settings, passes, false, [](double) {}, never);
  }
  Denoised denoised(const CompositeRender& render, CompositeMode mode) const {
    return *denoiseComposite(
        render.result, plate, mode, [](double) {}, never);
  }
  Image composed(const CompositeRender& render, CompositeMode mode) const {
    return compose(render.film(), render.mean, plate, mode).color;
  }
};

double relMse(const Image& image, const Image& reference) {
  return imageError(image, reference, nullptr, nullptr).relMse;
}

TEST(SlowDenoiseComposite, ReducesTheErrorAndKnowsIt) {
  const TwoBalls setup;
  const CompositeRender noisy = setup.render(16), exact = setup.render(2048, 1);
  for (const CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio}) {
    const Image reference = setup.composed(exact, mode);
    const double before = relMse(setup.composed(noisy, mode), reference);
    const Denoised found = setup.denoised(noisy, mode);
    const double after = relMse(found.color, reference);
    EXPECT_LT(after, before / 2) << int(mode);
    const double estimate = remainingNoise(relativeErrors(found));
    EXPECT_GT(estimate, 0.5 * std::sqrt(after)) << int(mode);
    EXPECT_LT(estimate, 2 * std::sqrt(after)) << int(mode);
  }
}

TEST(SlowDenoiseComposite, OfTwoPassesToo) {
  const TwoBalls setup;
  const Image reference = setup.composed(setup.render(2048, 1), CompositeMode::Difference);
  const CompositeRender noisy = setup.render(16, 0, Passes::Two);
  const Image found = setup.denoised(noisy, CompositeMode::Difference).color;
  EXPECT_LT(relMse(found, reference), relMse(noisy.mean, reference) / 5);
}

// The plate's bits beyond the local scene, and where no object is near.
TEST(DenoiseComposite, KeepsThePlate) {
  const TwoBalls setup;
  const CompositeRender noisy = setup.render(8);
  const Image alpha = compositeLayer(noisy.film(), CompositeLayer::Alpha);
  const Image difference = compositeLayer(noisy.film(), CompositeLayer::Difference);
  const auto isTouched = [&](int x, int y) {
    return *alpha.at(x, y) > 0 || difference.rgb(x, y) != Rgb(0);
  };
  const auto isNearTouched = [&](int x, int y) {
    constexpr int kReach = 7 + 1;
    for (int v = std::max(y - kReach, 0); v <= std::min(y + kReach, kHeight - 1); ++v)
      for (int u = std::max(x - kReach, 0); u <= std::min(x + kReach, kWidth - 1); ++u)
        if (isTouched(u, v)) return true;
    return false;
  };
  const Image disparity = noisy.result.features.disparity().mean;
  int beyond = 0, far = 0;
  for (const CompositeMode mode : {CompositeMode::Difference, CompositeMode::Ratio}) {
    const Denoised found = setup.denoised(noisy, mode);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        if (isTouched(x, y)) continue;
        const bool isBeyond = *disparity.at(x, y) == 0, isFar = !isNearTouched(x, y);
        if (!isBeyond && !isFar) continue;
        ASSERT_EQ(found.color.rgb(x, y), setup.plate.rgb(x, y)) << x << " " << y;
        ASSERT_EQ(*found.error.at(x, y), 0);
        beyond += isBeyond, far += isFar;
      }
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(far, 100);
}

TEST(DenoiseComposite, StopsAtOnce) {
  const TwoBalls setup;
  const std::atomic<bool> stop = true;
  EXPECT_FALSE(denoiseComposite(
      setup.render(2).result, setup.plate, CompositeMode::Difference, [](double) {}, stop));
}

}  // namespace
}  // namespace chromeball::denoise_composite_test
