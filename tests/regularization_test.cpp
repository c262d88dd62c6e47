// SPDX-License-Identifier: Apache-2.0
// Path-space regularisation: it conserves energy, leaves directly visible surfaces as they are,
// reduces variance, and its bias falls with the samples.
#include "transport/path_settings.h"

#include <gtest/gtest.h>

#include "measure/image_error.h"
#include "probe/synth.h"
#include "small_scenes.h"
#include "test_probes.h"

namespace chromeball::regularization_test {
namespace {

constexpr int kWidth = 20, kHeight = 15;

Material mirror() {
  Material m;
  m.roughness = 0;
  return m;
}

Material glass() {
  Material m;
  m.metallic = 0;
  m.roughness = 0;
  m.extended.emplace();
  m.extended->transmission = 1;
  m.extended->thinWalled = false;
  return m;
}

// A ball on a floor.
Scene ballOnFloor(const Material& ball, Rgb floor) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(floor)), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
  addSphere(scene, addMaterial(scene, ball), {0, 0.6f, 0}, 0.6f, 32);
  return scene;
}

Camera frontCamera() { return Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.3f, 0}, {0, 1, 0}, 0.6f); }

// The floor beside the ball, with its caustics.
Camera floorCamera() { return Camera::lookAt({1.2f, 2, 2}, {0.9f, 0, 0.9f}, {0, 1, 0}, 0.3f); }

RenderResult renderBall(const Scene& scene, const Probe& probe, uint32_t samples, bool regularize,
                        uint64_t seed = 0, const Camera& camera = frontCamera()) {
  RenderSettings settings = smallRender(kWidth, kHeight, samples, 12, seed);
  settings.regularize = regularize;
  return renderScene(scene, camera, probe, "importance", settings);
}

// White furnace test: wider lobes neither gain nor lose energy.
TEST(Regularization, ConservesEnergy) {
  const Probe white(constantProbe({32, 16}, Rgb(1)));
  for (const Material& ball : {mirror(), glass()}) {
    const Scene scene = ballOnFloor(ball, Rgb(1));
    RenderSettings settings = smallRender(16, 12, 64, 200);
    settings.regularize = true;
    const RenderResult result = renderScene(scene, frontCamera(), white, "importance", settings);
    EXPECT_NEAR(meanColor(result.film.mean()).y, 1, 0.01);
    EXPECT_EQ(result.invalid.total(), 0u);
  }
}

// The image keeps its bits where no path meets a glossy surface after a diffuse bounce.
TEST(Regularization, LeavesOtherPathsAlone) {
  const Probe studio(studioProbe({64, 32}));
  Scene matte = ballOnFloor(lambert(Rgb(0.5f)), Rgb(0.6f));
  Scene polished;
  addSphere(polished, addMaterial(polished, mirror()), vec3(0), 1, 32);
  for (const Scene* scene : {&matte, &polished})
    EXPECT_EQ(renderBall(*scene, studio, 16, true).film.mean().texels,
              renderBall(*scene, studio, 16, false).film.mean().texels);
}

// The mean of `repeats` renders.
Image meanOf(const Scene& scene, const Probe& probe, uint32_t samples, bool regularize,
             uint64_t firstSeed, uint64_t repeats) {
  Image mean(kWidth, kHeight, 3);
  for (uint64_t i = 0; i < repeats; ++i) {
    const Image one =
        renderBall(scene, probe, samples, regularize, firstSeed + i, floorCamera()).film.mean();
    for (size_t k = 0; k < one.texels.size(); ++k) mean.texels[k] += one.texels[k] / float(repeats);
  }
  return mean;
}

// The sum over the pixels of their variance over seeds. A small sun makes caustics, which
// regularized paths find by light samples.
TEST(SlowRegularization, ReducesTheVarianceOfCaustics) {
  const Probe sun(spot(256, 128, 120, 24, 8000, 0.2f));
  for (const Material& ball : {mirror(), glass()}) {
    const Scene scene = ballOnFloor(ball, Rgb(0.6f));
    const auto variance = [&](bool regularize) {
      constexpr uint64_t kRepeats = 16;
      double sum = 0, squares = 0;
      const Image mean = meanOf(scene, sun, 256, regularize, 1, kRepeats);
      for (uint64_t i = 0; i < kRepeats; ++i)
        for (const float texel : meanOf(scene, sun, 256, regularize, 1 + i, 1).texels)
          squares += double(texel) * texel / kRepeats;
      for (const float texel : mean.texels) sum += double(texel) * texel;
      return squares - sum;
    };
    EXPECT_LT(variance(true), variance(false) / 10);
  }
}

// Squared bias as the mean product of two independent differences from two references, in which
// noise averages out.
TEST(SlowRegularization, BiasFallsWithTheSamples) {
  const Probe sun(spot(64, 32, 30, 6, 500, 0.2f));
  const Scene scene = ballOnFloor(glass(), Rgb(0.6f));
  const Image references[] = {meanOf(scene, sun, 8192, false, 1, 1),
                              meanOf(scene, sun, 8192, false, 2, 1)};
  const auto squaredBias = [&](uint32_t samples) {
    const uint64_t repeats = 4096 / samples;
    const Image a = meanOf(scene, sun, samples, true, 10, repeats),
                b = meanOf(scene, sun, samples, true, 10000, repeats);
    double sum = 0;
    for (size_t i = 0; i < a.texels.size(); ++i)
      sum += double(a.texels[i] - references[0].texels[i]) *
             double(b.texels[i] - references[1].texels[i]);
    return sum;
  };
  const double few = squaredBias(4), many = squaredBias(256), most = squaredBias(4096);
  EXPECT_LT(many, 0.5 * few);
  EXPECT_LT(most, 0.5 * many);
}

TEST(Regularization, WidthsAndSpreads) {
  EXPECT_FLOAT_EQ(regularizationWidth(63), regularizationWidth(0) / 2);
  EXPECT_EQ(spreadOf(1e-20f), 1);
  EXPECT_FLOAT_EQ(spreadOf(1 / kPi), 1);
  EXPECT_EQ(spreadOf(1e30f), 1 / std::sqrt(kPi * 1e30f));
}

}  // namespace
}  // namespace chromeball::regularization_test
