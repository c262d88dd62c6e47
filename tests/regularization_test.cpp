// SPDX-License-Identifier: Apache-2.0
// Path-space regularisation: it conserves energy, leaves what the camera sees directly as it is,
// reduces variance, and its bias falls with the samples.
#include "integrate/regularization.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "measure/image_error.h"
#include "probe/synth.h"
#include "small_scenes.h"
#include "test_probes.h"

namespace chromeball {
namespace {

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

RenderResult renderBall(const Scene& scene, const Probe& probe, uint32_t samples, bool regularize,
                        uint64_t seed = 0) {
  RenderSettings settings = smallRender(32, 24, samples, 12, seed);
  settings.regularize = regularize;
  return renderScene(scene, frontCamera(), probe, "importance", settings);
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

// The same bits where no path meets a glossy surface after a diffuse bounce.
TEST(Regularization, LeavesOtherPathsAlone) {
  const Probe studio(studioProbe({64, 32}));
  Scene matte = ballOnFloor(lambert(Rgb(0.5f)), Rgb(0.6f));
  Scene polished;
  addSphere(polished, addMaterial(polished, mirror()), vec3(0), 1, 32);
  for (const Scene* scene : {&matte, &polished})
    EXPECT_EQ(renderBall(*scene, studio, 16, true).film.mean().texels,
              renderBall(*scene, studio, 16, false).film.mean().texels);
}

TEST(Regularization, DoesNotDependOnThreads) {
  const Probe studio(studioProbe({64, 32}));
  const Scene scene = ballOnFloor(glass(), Rgb(0.6f));
  const auto with = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return renderBall(scene, studio, 16, true).film.mean().texels;
  };
  EXPECT_EQ(with(1), with(3));
}

// A small sun makes caustics, which regularized paths find by light samples.
TEST(SlowRegularization, ReducesTheErrorOfCaustics) {
  const Probe sun(spot(64, 32, 30, 6, 500, 0.2f));
  for (const Material& ball : {mirror(), glass()}) {
    const Scene scene = ballOnFloor(ball, Rgb(0.6f));
    const Image reference = renderBall(scene, sun, 16384, false, 1).film.mean();
    const auto error = [&](uint32_t samples, bool regularize) {
      double sum = 0;
      for (uint64_t seed = 2; seed < 6; ++seed)
        sum += imageError(renderBall(scene, sun, samples, regularize, seed).film.mean(), reference,
                          nullptr, nullptr)
                   .relMse;
      return sum / 4;
    };
    EXPECT_LT(error(16, true), error(16, false) / 1.5);
    EXPECT_LT(error(1024, true), error(16, true) / 3);
  }
}

// The mean of the image approaches that of the unbiased render.
TEST(SlowRegularization, BiasFallsWithTheSamples) {
  const Probe sun(spot(64, 32, 30, 6, 500, 0.2f));
  const Scene scene = ballOnFloor(mirror(), Rgb(0.6f));
  const Image reference = renderBall(scene, sun, 32768, false, 1).film.mean();
  const auto squaredBias = [&](uint32_t samples) {  // of the mean of as many samples in all
    Image mean(reference.width, reference.height, 3);
    const uint64_t repeats = 16384 / samples;
    for (uint64_t seed = 10; seed < 10 + repeats; ++seed) {
      const Image one = renderBall(scene, sun, samples, true, seed).film.mean();
      for (size_t i = 0; i < one.texels.size(); ++i)
        mean.texels[i] += one.texels[i] / float(repeats);
    }
    return imageError(mean, reference, nullptr, nullptr).relMse;
  };
  const double few = squaredBias(4), many = squaredBias(256), most = squaredBias(16384);
  EXPECT_LT(many, 0.7 * few);
  EXPECT_LT(most, 0.7 * many);
}

TEST(Regularization, WidthsAndSpreads) {
  EXPECT_FLOAT_EQ(regularizationWidth(63), regularizationWidth(0) / 2);
  EXPECT_EQ(spreadOf(1e-20f), 1);
  EXPECT_FLOAT_EQ(spreadOf(1 / kPi), 1);
  EXPECT_EQ(spreadOf(1e30f), 1 / std::sqrt(kPi * 1e30f));
}

}  // namespace
}  // namespace chromeball
