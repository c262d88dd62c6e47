// SPDX-License-Identifier: Apache-2.0
// Ways of rendering (guide, regularisation, straight shadows of glass, denoising) and their
// combinations: determinism, extremes of radiance, limits of noise.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "probe/synth.h"
#include "scene/extended_surface.h"
#include "session/denoised_image.h"
#include "study/study.h"
#include "test_probes.h"
#include "test_scene.h"

namespace chromeball::modes_test {
namespace {

const char* const kRows[] = {"importance+regularize", "importance+glass-shadows",
                             "importance+denoise", "importance+adaptive+guide+regularize",
                             "importance+adaptive+guide+regularize+glass-shadows+denoise"};

// A glass ball with absorption, a mirror and a rough metal on a floor between two walls.
Scene room() {
  Scene scene;
  const int matte = addMaterial(scene, lambert({0.7f, 0.6f, 0.5f}));
  addQuad(scene, matte, {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addQuad(scene, matte, {-1.5f, 0, 2}, {0, 0, -4}, {0, 3, 0});
  addQuad(scene, matte, {-1.5f, 0, -1.5f}, {3, 0, 0}, {0, 3, 0});
  Material glass;
  glass.metallic = 0;
  glass.roughness = 0;
  glass.extended.emplace();
  glass.extended->transmission = 1;
  glass.extended->thinWalled = false;
  glass.extended->attenuation = {0.1f, 1, 2};
  addSphere(scene, addMaterial(scene, glass), {0.3f, 0.5f, 0.3f}, 0.5f, 24);
  Material metal;
  metal.baseColor = {1, 0.8f, 0.4f, 1};
  metal.roughness = 0;
  addSphere(scene, addMaterial(scene, metal), {-0.8f, 0.4f, 0.4f}, 0.4f, 24);
  metal.roughness = 0.4f;
  addSphere(scene, addMaterial(scene, metal), {1, 0.3f, 1}, 0.3f, 24);
  return scene;
}

struct Picture {
  Image image;
  RenderResult result;
};

Picture renderRow(const std::string& name, const Probe& probe, uint32_t samples,
                  std::optional<double> noiseLimit = {}) {
  const Row row = rowNamed(name, "test");
  Scene scene = room();
  if (row.has(Mode::GlassShadows)) passShadowsStraight(scene.materials);
  RenderSettings settings = row.applied(smallRender(48, 36, samples, 6));
  settings.noiseLimit = noiseLimit;
  const Camera camera = Camera::lookAt({0.5f, 2, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.6f);
  RenderResult result = renderScene(scene, camera, probe, row.strategy, settings);
  Image image = result.film.mean();
  const std::atomic<bool> never = false;
  if (settings.denoise)
    image = denoiseRender(
                result, [](double) {}, never)
                ->color;
  return {std::move(image), std::move(result)};
}

Probe sunny(float scale) { return Probe(spot(64, 32, 40, 6, 500 * scale, 0.2f * scale)); }

TEST(SlowModes, DoNotDependOnThreads) {
  for (const char* row : kRows) {
    const auto with = [&](size_t threads) {
      const ThreadLimit limit(threads);
      return renderRow(row, sunny(1), 24).image.texels;
    };
    EXPECT_EQ(with(1), with(3)) << row;
  }
}

// A probe of any brightness gives the same image, times its brightness.
TEST(SlowModes, BearRadianceFromTinyToHuge) {
  for (const char* row : kRows) {
    const Image expected = renderRow(row, sunny(1), 24).image;
    const double mean = luminance(meanColor(expected));
    for (const float scale : {1e-8f, 1e10f}) {
      const Picture found = renderRow(row, sunny(scale), 24);
      EXPECT_EQ(found.result.invalid.total(), 0u) << row;
      EXPECT_NEAR(luminance(meanColor(found.image)) / scale / mean, 1, 0.01) << row << scale;
      for (const float texel : found.image.texels) ASSERT_TRUE(std::isfinite(texel)) << row;
    }
  }
}

TEST(Modes, StopAtALimitOfNoise) {
  for (const char* row : kRows) {
    constexpr double kLimit = 0.1;
    const RenderResult result =
        renderRow(row, Probe(gradientProbe({32, 16}, Rgb(0.5f), {0, 0.3, 0.2})), 1 << 14, kLimit)
            .result;
    EXPECT_LT(result.samples, 1u << 14) << row;
    EXPECT_LT(result.film.noise().noise, kLimit) << row;
  }
}

}  // namespace
}  // namespace chromeball::modes_test
