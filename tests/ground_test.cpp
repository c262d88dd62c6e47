// SPDX-License-Identifier: Apache-2.0
// The ground that nobody has modelled, and the probe's scale by the plate's ground.
#include "composite/local_scene.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "composite/plate.h"
#include "test_scene.h"

namespace chromeball::ground_test {
namespace {

Scene unitBall() {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 1, 0}, 1, 16);
  return scene;
}

// 30 times the size and distance on all sides: also behind the camera, whose ground lights the
// objects.
TEST(Ground, ReachesFarOnAllSides) {
  const Bounds ball = bounds(unitBall());
  const double size = glm::length(ball.size());
  const Camera level = Camera::lookAt({3, 2, 8}, {0, 1.9f, 0}, {0, 1, 0}, 0.8f);
  const Ground ground = groundAround(level, 1.5f, ball, 0.5f, "scene.toml:3");
  const double reach = 30 * (size + glm::distance(glm::dvec3(3, 2, 8), glm::dvec3(0, 1, 0)));
  EXPECT_EQ(ground.height, 0.5f);
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(ground.min[axis], -reach, 1e-4 * reach);
    EXPECT_NEAR(ground.max[axis], reach, 1e-4 * reach);
  }
}

TEST(Ground, CamerasMustSeeIt) {
  const Bounds ball = bounds(unitBall());
  const auto reason = [&](const Camera& camera, float height) -> std::string {
    try {
      groundAround(camera, 1, ball, height, "scene.toml:3");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(reason(topCamera(10, 40), 12),
            "scene.toml:3: the camera is 2 m below the ground; give one of them another height");
  EXPECT_EQ(reason(Camera::lookAt({0, 1, 5}, {0, 9, 0}, {0, 1, 0}, 0.5f), 0),
            "scene.toml:3: the camera does not see the ground; it looks above the horizon");
}

TEST(Ground, IsAMatteNodeOfTheScene) {
  Scene scene = unitBall();
  scene.nodeParents = {-1};
  addGround(scene, {0.5f, {-2, -3}, {4, 5}}, Rgb(0.1f, 0.2f, 0.3f));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.nodeNames[size_t(scene.instances[1].node)], kGroundNode);
  EXPECT_EQ(scene.nodeParents.size(), 2u);
  const Mesh& mesh = scene.meshes.back();
  const vec3 normal =
      glm::cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]);
  EXPECT_GT(normal.y, 0);
  const Bounds box = bounds(scene, scene.instances[1]);
  EXPECT_EQ(vec2(box.min.x, box.max.z), vec2(-2, 5));
  EXPECT_NEAR(box.max.y, 0.5f, 1e-4);
  EXPECT_LT(box.max.y, 0.5f);  // below the objects on it
}

// Half of the pixels show other things; the median is the ground's.
TEST(Ground, TheProbesScaleIsThatOfThePlatesMedian) {
  Image plate(30, 20, 3);
  std::vector<size_t> pixels;
  const Rgb ground(0.2f, 0.1f, 0.05f);
  for (int i = 0; i < 600; ++i) {
    const float scatter = 1 + 0.2f * (toUnit(uint32_t(hash(i))) - 0.5f);
    plate.setRgb(i % 30, i / 30, i % 3 == 0 ? Rgb(i % 2 ? 9.0f : 0.001f) : scatter * ground);
    if (i >= 60) pixels.push_back(size_t(i));
  }
  const Rgb irradiance(2, 1, 0.5f), reflectance(0.4f, 0.3f, 0.2f);
  const PlateScale found = scaleByPlate(plate, pixels, irradiance, reflectance);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(found.scale[c] * reflectance[c] * irradiance[c] / (kPi * ground[c]), 1, 0.02);
  EXPECT_EQ(found.pixels, 540u);
  EXPECT_GT(found.scatter, 0.05);

  // Uniform to +-10%: 68% span 13.6%.
  for (int i = 0; i < 600; ++i)
    plate.setRgb(i % 30, i / 30, (1 + 0.2f * (toUnit(uint32_t(hash(i))) - 0.5f)) * ground);
  EXPECT_NEAR(scaleByPlate(plate, pixels, irradiance, reflectance).scatter, 0.068, 0.006);
}

TEST(Ground, PixelsBehindWallsDoNotShowIt) {
  Scene scene;
  const Camera camera = topCamera(5, 90);
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-9, 1, 9}, {9, 0, 0}, {0, 0, -18});
  addGround(scene, {0, {-20, -20}, {20, 20}}, Rgb(0.5f));
  const auto shown = [&](const Bounds& part) {
    return pixelsThatShow(scene.instances.back().node, part, scene, camera, 16, 16);
  };
  const Bounds all{vec3(-INFINITY), vec3(INFINITY)};
  EXPECT_EQ(shown(all).size(), 128u);  // the right half
  for (const size_t pixel : shown(all)) EXPECT_GE(pixel % 16, 8u);
  // The camera sees 10 m across.
  const std::vector<size_t> part = shown({{-1, 7, -1.25f}, {2.5f, 8, 5}});
  EXPECT_EQ(part.size(), 4u * 10);
  for (const size_t pixel : part) EXPECT_LT(pixel % 16, 12u);
}

// In a photograph a white surface is about 1.
TEST(Ground, ItsReflectanceInAPhotographIsItsLuminance) {
  const Image plate = colorImage(8, 8, [](int, int) { return Rgb(0.3f); });
  const std::vector<size_t> pixels = {3, 4, 5};
  EXPECT_NEAR(reflectanceInPhotograph(plate, pixels, {0.1f, 0.5f}), 0.3f, 1e-6f);
  EXPECT_EQ(reflectanceInPhotograph(plate, pixels, {0.1f, 0.2f}), 0.2f);
  EXPECT_EQ(reflectanceInPhotograph(plate, pixels, {0.4f, 0.5f}), 0.4f);
}

}  // namespace
}  // namespace chromeball::ground_test
