// SPDX-License-Identifier: Apache-2.0
// Mirror balls that the path tracer renders: its photographs must return the probe that lit the
// ball, and the ball's reflectivity.
#include <gtest/gtest.h>

#include "capture_photographs.h"
#include "probe/capture/assemble.h"
#include "probe/capture/reflectivity.h"
#include "probe/convert.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::rendered_ball_test {
namespace {

const Rgb kChrome(0.632f, 0.647f, 0.653f);

Material mirror(const Rgb& color) {
  Material material;
  material.baseColor = vec4(color, 1);
  material.roughness = 0;
  return material;
}

// Looks at the origin; the ball's outline has a radius of 1/1.1 of half the picture's height.
Camera cameraAt(const CameraPosition& position, double distance) {
  const CameraAxes axes(position);
  const double apart = std::isfinite(distance) ? distance : 10;
  const double half = 1.1 / std::sqrt(apart * apart - 1);
  Camera camera = Camera::lookAt(vec3(apart * axes.backwards), vec3(0), vec3(0, 1, 0),
                                 float(2 * std::atan(half)));
  camera.orthographic = !std::isfinite(distance);
  camera.halfHeight = 1.1f;
  return camera;
}

TEST(SlowRenderedBall, ReturnsTheProbe) {
  constexpr int kPixels = 240;
  constexpr ImageSize kSize{256, 128};
  const Image map = convert(studioProbe({512, 256}), Mapping::LatLong, Mapping::LatLong, kSize);
  const Probe probe(map);
  Scene scene;
  addSphere(scene, addMaterial(scene, mirror(kChrome)), vec3(0), 1, 200);
  for (const double distance : {kParallel, 32.0}) {
    const Circle circle{dvec2(0.5 * kPixels), 0.5 * kPixels / 1.1};
    const auto optics =
        std::make_shared<BallOptics>(distance, BallReflectance::schlick(dvec3(kChrome)), 15);
    const Image noMask;
    std::vector<Image> photographs;
    std::vector<CaptureView> views;
    photographs.reserve(2);
    for (const double azimuth : {0.0, 90.0}) {
      const CameraPosition camera{azimuth, 0};
      photographs.push_back(renderScene(scene, cameraAt(camera, distance), probe, "bsdf",
                                        smallRender(kPixels, kPixels, 64, 2))
                                .film.mean());
      views.emplace_back(photographs.back(), noMask, circle, optics, camera);
    }
    const IrradianceError error = irradianceError(assemble(views, kSize).latLong, map);
    EXPECT_LT(error.mean, 0.005) << distance;
    EXPECT_LT(error.largest, 0.02) << distance;
  }
}

// HDRI book, figure 9.10: a card beside a ball, seen directly and in the ball. Both are lit by a
// constant probe; the card is Lambertian and emits, so that it differs from its surroundings.
TEST(SlowRenderedBall, ReturnsItsReflectivity) {
  for (const Rgb& color : {kChrome, Rgb(0.59f)}) {
    Scene scene;
    addSphere(scene, addMaterial(scene, mirror(color)), vec3(0), 1, 100);
    Material card = lambert(Rgb(0.2f));
    card.emission = Rgb(4, 3, 2);
    // Close to the axis of the camera and behind the ball's centre towards it, so that its
    // reflection leaves the ball at nearly normal incidence.
    addQuad(scene, addMaterial(scene, card), vec3(-3, -1, 6), vec3(0, 2, 0), vec3(2, 0, 0));
    Camera camera = Camera::lookAt(vec3(0, 0, 12), vec3(0), vec3(0, 1, 0), 0.5f);
    const int width = 320;
    const Image image = renderScene(scene, camera, Probe(constantProbe({8, 4}, Rgb(0.5f))), "bsdf",
                                    smallRender(width, width, 64, 4))
                            .film.mean();
    // The card spans 1 to 3 m left of the axis at 6 m from the camera: 9.5 to 26.6 degrees; the
    // picture shows up to 14.3.
    const PatchMean direct = patchMean(image, {5, 150, 30, 20}, 1e4, "card");
    EXPECT_GT(direct.mean.x, 4);
    // In the ball: the direction (-2, 0, 6), at 18 degrees, is reflected at 9 degrees from the
    // axis.
    const int x = int(160 - 160 * std::sin(9.2 * kPiD / 180) / 12 / std::tan(0.25));
    const PatchMean reflected = patchMean(image, {x - 2, 158, 4, 4}, 1e4, "ball");
    const Reflectivity result = reflectivity(reflected, direct, dvec3(1), "card");
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(result.value[c] / double(color[c]), 1, 0.01) << c;
  }
}

}  // namespace
}  // namespace chromeball::rendered_ball_test
