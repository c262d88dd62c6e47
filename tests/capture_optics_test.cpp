// SPDX-License-Identifier: Apache-2.0
// The geometry and the reflectance of a photographed mirror ball.
#include "probe/capture/optics.h"

#include <gtest/gtest.h>

#include "capture_photographs.h"

namespace chromeball::capture_optics_test {
namespace {

// The reflected direction in vector form, for a camera at azimuth 0, whose frame is the world's.
dvec3 reflectedDirection(double distance, const dvec2& p) {
  const CameraAxes axes({0, 0});
  dvec3 origin(p, 2), ray(0, 0, -1);
  if (std::isfinite(distance)) {
    origin = {0, 0, distance};
    ray = glm::normalize(dvec3(p / std::sqrt(distance * distance - 1), -1));
  }
  const double b = glm::dot(origin, ray), c = glm::dot(origin, origin) - 1;
  return glm::reflect(ray, origin + (-b - std::sqrt(b * b - c)) * ray);
}

constexpr double kDistances[] = {kParallel, 1000, 32, 4, 1.2};

TEST(BallOptics, ReflectsAsAMirror) {
  for (const double distance : kDistances) {
    const BallOptics optics(distance, BallReflectance(), 0);
    // The vector form loses digits in the difference of squares of the distance, of size 1.
    const double rounding = 1e-11 + (std::isfinite(distance) ? 1e-14 * distance * distance : 0);
    for (int i = 0; i <= 50; ++i) {
      const double radius = 0.999 * i / 50, around = 0.4 + i;
      const dvec2 p = radius * dvec2(std::cos(around), std::sin(around));
      const BallOptics::Reflection reflection = optics.reflection(p);
      EXPECT_LT(glm::distance(reflection.direction, reflectedDirection(distance, p)), rounding)
          << distance << " " << radius;
      const std::optional<DiscPoint> back = optics.locate(reflection.direction);
      ASSERT_TRUE(back);
      EXPECT_LT(glm::distance(back->position, p), 1e-12) << distance << " " << radius;
    }
  }
}

TEST(BallOptics, ShowsTheCameraInTheCentreAndItsRightOnTheRight) {
  const BallOptics optics(kParallel, BallReflectance(), 0);
  EXPECT_LT(glm::length(optics.locate({0, 0, 1})->position), 1e-15);
  EXPECT_NEAR(optics.locate({1, 0, 0})->position.x, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(optics.locate({0, 1, 0})->position.y, std::sqrt(0.5), 1e-15);
}

TEST(BallOptics, IsBlindInACone) {
  for (const double distance : kDistances) {
    const BallOptics optics(distance, BallReflectance(), 0);
    const double blind = std::asin(1 / distance);
    const auto at = [&](double fromBack) {
      return optics.locate({std::sin(fromBack), 0, -std::cos(fromBack)});
    };
    EXPECT_TRUE(at(blind + 1e-6));
    if (blind > 0) {
      EXPECT_FALSE(at(blind - 1e-6));
    }
    EXPECT_NEAR(optics.shareShown(), 0.5 * (1 + std::cos(blind)), 1e-15);
  }
  EXPECT_NEAR(std::asin(1 / 32.) * 180 / kPiD, 1.79, 0.005);
}

// Lengths along the radius shrink by cos(i): the weight falls with it, and towards the camera.
TEST(BallOptics, WeighsWhatItShowsWell) {
  const BallOptics optics(kParallel, BallReflectance(), 15);
  const auto weight = [&](double degrees) {
    const double t = degrees * kPiD / 180;
    return optics.locate({std::sin(t), 0, std::cos(t)})->weight;
  };
  EXPECT_LT(weight(0), 0.002);
  EXPECT_GT(weight(0), 0);
  const double cosine = std::sqrt(0.5);
  EXPECT_NEAR(weight(90), cosine * cosine * (3 - 2 * cosine), 1e-12);
  EXPECT_GT(weight(15), weight(90));
  EXPECT_GT(weight(90), weight(170));
}

TEST(BallReflectance, OfMetals) {
  EXPECT_NEAR(metalFresnel(1, {3.18, 3.31}), 0.553, 5e-4);  // chromium
  EXPECT_NEAR(metalFresnel(1, {1.37, 7.62}), 0.915, 2e-3);  // aluminium, in red light
  for (const MetalIndex& m : {MetalIndex{3.18, 3.31}, MetalIndex{0.2, 3}, MetalIndex{1.5, 0}}) {
    const double k2 = m.k * m.k;
    EXPECT_NEAR(metalFresnel(1, m), ((m.n - 1) * (m.n - 1) + k2) / ((m.n + 1) * (m.n + 1) + k2),
                1e-15);
    EXPECT_NEAR(metalFresnel(0, m), 1, 1e-12);
  }
  // Glass at Brewster's angle, tan(i) = n, reflects one polarisation only: half of
  // ((n^2 - 1) / (n^2 + 1))^2.
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(metalFresnel(std::cos(brewster), {1.5, 0}), 0.5 * std::pow(1.25 / 3.25, 2), 1e-15);
}

TEST(BallReflectance, IsMeasuredAtTheCentre) {
  const dvec3 measured(0.632, 0.647, 0.653);
  const BallReflectance constant(measured),
      schlick = BallReflectance::schlick(measured),
      chrome = BallReflectance::ofMetal(measured, {3.18, 3.31});
  for (const BallReflectance& reflectance : {constant, schlick, chrome})
    EXPECT_LT(glm::distance(reflectance.at(1), measured), 1e-15);
  EXPECT_EQ(constant.at(0.1), measured);
  EXPECT_EQ(schlick.at(0), dvec3(1));
  EXPECT_NEAR(chrome.at(0.5).x / measured.x,
              metalFresnel(0.5, {3.18, 3.31}) / metalFresnel(1, {3.18, 3.31}), 1e-15);
}

}  // namespace
}  // namespace chromeball::capture_optics_test
