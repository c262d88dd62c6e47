// SPDX-License-Identifier: Apache-2.0
// Lenses with radial distortion and a shifted axis: rays, image positions, footprints, renders.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include "base/hash.h"
#include "test_scene.h"

namespace chromeball::distortion_test {
namespace {

const std::vector<Distortion> kLenses = {{-0.2, 0},    {0.3, 0},     {-0.25, 0.06}, {0.1, -0.02},
                                         {-0.3, 0.02}, {0.02, 0.01}, {0, -0.05}};

TEST(Distortion, UndistortedInvertsDistorted) {
  for (const Distortion& lens : kLenses) {
    const double end = std::min(0.999 * lens.fold(), 3.0);
    for (int i = 0; i <= 200; ++i) {
      const double radius = end * i / 200;
      ASSERT_TRUE(lens.reaches(lens.distorted(radius)));
      // Near the fold the inverse has an infinite slope.
      EXPECT_NEAR(lens.undistorted(lens.distorted(radius)), radius,
                  1e-14 + 1e-15 * radius / lens.slope(radius))
          << lens.k1 << " " << lens.k2;
    }
  }
  EXPECT_EQ(Distortion().undistorted(1.7), 1.7);
}

// At the fold the slope is 0; before, it is positive.
TEST(Distortion, FoldsWhereTheSlopeIsZero) {
  EXPECT_DOUBLE_EQ(Distortion({-0.3, 0}).fold(), std::sqrt(1 / 0.9));
  EXPECT_TRUE(std::isinf(Distortion({0.3, 0}).fold()));
  EXPECT_TRUE(std::isinf(Distortion({-0.25, 0.06}).fold()));  // 0.75^2 < 4 x 0.3
  EXPECT_TRUE(std::isinf(Distortion().fold()));
  for (const Distortion& lens : kLenses) {
    const double fold = lens.fold();
    if (std::isinf(fold)) continue;
    EXPECT_NEAR(lens.slope(fold), 0, 1e-12);
    for (int i = 0; i < 100; ++i) EXPECT_GT(lens.slope(fold * i / 100), 0);
    EXPECT_FALSE(lens.reaches(lens.distorted(fold) * (1 + 1e-12)));
    EXPECT_FALSE(lens.reaches(1e30));
    EXPECT_EQ(lens.undistorted(1e30), fold);
  }
}

Camera distortedCamera(const Distortion& distortion) {
  Camera camera = Camera::lookAt({0.5f, 2.5f, 4}, {0, 0.4f, 0}, {0.1f, 1, 0}, 0.6f);
  camera.principalPoint = {0.45f, 0.58f};
  camera.distortion = distortion;
  return camera;
}

TEST(Distortion, ViewsInvertRays) {
  constexpr double kAspect = 1.5;
  for (const Distortion& lens : kLenses) {
    const Camera camera = distortedCamera(lens);
    ASSERT_TRUE(fillsImage(camera, kAspect));
    const CameraRays rays(camera, kAspect);
    const CameraView view(camera, kAspect);
    for (int i = 0; i < 300; ++i) {
      const float u = toUnit(uint32_t(hash(3 * i))), v = toUnit(uint32_t(hash(3 * i + 1)));
      const float distance = 0.5f + 9 * toUnit(uint32_t(hash(3 * i + 2)));
      vec3 origin, direction;
      rays.ray(u, v, origin, direction);
      EXPECT_NEAR(glm::length(direction), 1, 1e-6);
      const auto seen = view.at(glm::dvec3(origin + distance * direction));
      ASSERT_TRUE(seen);
      EXPECT_NEAR(seen->position.x, u, 4e-6);
      EXPECT_NEAR(seen->position.y, v, 4e-6);
      EXPECT_NEAR(seen->depth, rays.depth(direction, distance), 1e-5);
    }
    EXPECT_FALSE(view.at(glm::dvec3(camera.position + camera.back)));
  }
}

// Points beyond the fold would appear inside the image.
TEST(Distortion, PointsBeyondTheFoldAreNotSeen) {
  Camera camera;
  camera.fov = kPi / 2;
  camera.distortion = {-0.2, 0};
  const double fold = camera.distortion.fold();
  const CameraView view(camera, 1);
  EXPECT_TRUE(view.at({0.99 * fold, 0, -1}));
  EXPECT_FALSE(view.at({1.5 * fold, 0, -1}));
  Projection projection(camera, 8, 8);
  Image depth(8, 8, 1);
  for (float& texel : depth.texels) texel = 100;
  projection.setDepth(depth);
  EXPECT_TRUE(projection.lookup({0, 0.1f, -1}));
  EXPECT_FALSE(projection.lookup({float(1.65 * fold), 0, -1}));
}

TEST(Distortion, TheWholeImageMustBeBeforeTheFold) {
  Camera camera;
  camera.fov = kPi / 2;  // the corners of a square image are at the radius sqrt(2)
  camera.distortion = {-0.04, 0};
  EXPECT_TRUE(fillsImage(camera, 1));
  camera.distortion = {-0.08, 0};  // the fold is at 1.36
  EXPECT_FALSE(fillsImage(camera, 1));
  camera.distortion = {-0.04, 0};
  camera.principalPoint = {-0.2f, 0.5f};
  EXPECT_FALSE(fillsImage(camera, 1));
  camera.orthographic = true;
  EXPECT_TRUE(fillsImage(camera, 1));
}

// A pixel's beam has the area of the part of the plane at distance 1 that the pixel shows.
TEST(Distortion, BeamsHaveTheAreaOfTheirPixels) {
  for (const Distortion& lens : kLenses) {
    const Camera camera = distortedCamera(lens);
    const CameraRays rays(camera, 1.5f);
    const auto planePoint = [&](float u, float v) {
      vec3 origin, direction;
      rays.ray(u, v, origin, direction);
      return glm::dvec3(direction) / double(-glm::dot(direction, camera.back));
    };
    for (const vec2 at : {vec2(0.45f, 0.58f), vec2(0.1f, 0.2f), vec2(0.9f, 0.5f)}) {
      constexpr float kStep = 5e-3f;
      const glm::dvec3 across = planePoint(at.x + kStep, at.y) - planePoint(at.x - kStep, at.y);
      const glm::dvec3 down = planePoint(at.x, at.y + kStep) - planePoint(at.x, at.y - kStep);
      const double side = 2 * std::tan(0.3) * 2 * kStep;
      const double area = glm::length(glm::cross(across, down)) / (1.5 * side * side);
      EXPECT_NEAR(rays.beamAt({0, 1}, at.x, at.y).solidAngle / area, 1, 2e-3)
          << lens.k1 << " " << lens.k2 << " at " << at.x;
    }
  }
  EXPECT_EQ(CameraRays(Camera(), 1).beamAt({0, 0.5f}, 0.1f, 0.1f).solidAngle, 0.5f);
}

// Lens rays still meet where the pinhole's ray pierces the plane in focus.
TEST(Distortion, ThinLensesFocusDistortedImages) {
  Camera camera = distortedCamera({-0.2, 0});
  camera.lensRadius = 0.2f;
  camera.focus = 3;
  const CameraRays rays(camera, 1.5f);
  vec3 origin, direction;
  rays.ray(0.1f, 0.9f, origin, direction);
  const vec3 inFocus = origin + direction * (3 / -glm::dot(direction, camera.back));
  rays.ray(0.1f, 0.9f, vec2(0.9f, 0.3f), origin, direction);
  EXPECT_GT(glm::distance(origin, camera.position), 0.05f);
  EXPECT_LT(glm::length(glm::cross(inFocus - origin, direction)), 3e-6f);
}

// Small lamps on a grid appear at (1 + k1 r^2 + k2 r^4) (x, y) focal lengths from the axis.
TEST(Distortion, RendersAGridWhereTheFormulaPutsIt) {
  constexpr int kWidth = 240, kHeight = 160, kReach = 12;
  constexpr double kSpacing = 0.18, kSize = 0.012;
  Camera camera;
  camera.fov = 0.9f;
  camera.principalPoint = {0.47f, 0.54f};
  camera.distortion = {-0.22, 0.05};
  Scene scene;
  Material lamp = lambert(Rgb(0));
  lamp.emission = Rgb(1);
  const int material = addMaterial(scene, lamp);
  for (int row = -1; row <= 1; ++row)
    for (int column = -2; column <= 2; ++column)
      addQuad(scene, material,
              {float(kSpacing * column - kSize), float(kSpacing * row - kSize), -1},
              {float(2 * kSize), 0, 0}, {0, float(2 * kSize), 0});
  const Image image =
      renderScene(scene, camera, Probe(Image(2, 1, 3)), "bsdf", smallRender(kWidth, kHeight, 64, 0))
          .film.mean();
  const double f = 0.5 * kHeight / std::tan(0.45);
  double farthest = 0;
  for (int row = -1; row <= 1; ++row)
    for (int column = -2; column <= 2; ++column) {
      const double x = kSpacing * column, y = kSpacing * row, r2 = x * x + y * y;
      const double scale = 1 - 0.22 * r2 + 0.05 * r2 * r2;
      const glm::dvec2 axis(0.47 * kWidth, 0.54 * kHeight);
      const glm::dvec2 expected = axis + f * scale * glm::dvec2(x, -y);
      glm::dvec2 sum(0);
      double weight = 0;
      for (int j = -kReach; j <= kReach; ++j)
        for (int i = -kReach; i <= kReach; ++i) {
          const int px = int(expected.x) + i, py = int(expected.y) + j;
          const double value = image.rgb(px, py).x;
          sum += value * glm::dvec2(px + 0.5, py + 0.5);
          weight += value;
        }
      ASSERT_GT(weight, 5);
      // A lamp is 4 pixels wide; 64 stratified samples find its edges to a few per cent of a pixel.
      EXPECT_LT(glm::distance(sum / weight, expected), 0.05) << row << " " << column;
      farthest = std::max(farthest, f * (1 - scale) * std::sqrt(r2));
    }
  EXPECT_GT(farthest, 2);  // from where a pinhole shows it
}

}  // namespace
}  // namespace chromeball::distortion_test
