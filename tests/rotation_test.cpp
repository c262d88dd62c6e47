// SPDX-License-Identifier: Apache-2.0
// Rotations: their angles, quaternions and order.
#include "math/rotation.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "sphere_test.h"

namespace chromeball::rotation_test {
namespace {

using glm::dquat;
using glm::dvec3;

const dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

void expectNear(const dvec3& a, const dvec3& b, double tolerance = 1e-12) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " and " << b.x << " " << b.y << " " << b.z;
}

double between0And1(int i, int d) { return double(random1(i, d)); }

Rotation::Angles randomAngles(int i) {
  return {360 * between0And1(i, 0) - 180, 180 * between0And1(i, 1) - 90,
          360 * between0And1(i, 2) - 180};
}

// The map's centre is -Z, its right +X.
TEST(Rotation, YawMovesTheCentreToTheLeftPitchLiftsItAndRollLiftsTheRight) {
  expectNear(Rotation(90)(-kZ), -kX);
  expectNear(Rotation::ofAngles({90, 0, 0})(-kZ), -kX);
  expectNear(Rotation::ofAngles({0, 90, 0})(-kZ), kY);
  expectNear(Rotation::ofAngles({0, 0, 90})(kX), kY);
}

TEST(Rotation, RollComesFirstAndYawLast) {
  for (int i = 0; i < 100; ++i) {
    const Rotation::Angles a = randomAngles(i);
    const dvec3 d = glm::normalize(dvec3(between0And1(i, 3), between0And1(i, 4), -0.5));
    const dvec3 rolled = Rotation::ofAngles({0, 0, a.roll})(d);
    const dvec3 pitched = Rotation::ofAngles({0, a.pitch, 0})(rolled);
    expectNear(Rotation::ofAngles(a)(d), Rotation(float(a.yaw))(pitched), 1e-6);
  }
}

TEST(Rotation, AnglesAndQuaternionsGiveTheSameRotationBack) {
  for (int i = 0; i < 1000; ++i) {
    const Rotation::Angles a = randomAngles(i), b = Rotation::ofAngles(a).angles();
    EXPECT_NEAR(a.yaw, b.yaw, 1e-9);
    EXPECT_NEAR(a.pitch, b.pitch, 1e-9);
    EXPECT_NEAR(a.roll, b.roll, 1e-9);
    const dquat q = Rotation::ofAngles(a).quaternion();
    const Rotation again = Rotation::ofQuaternion(-2.0 * q);
    for (const dvec3& axis : {kX, kY, kZ}) expectNear(again(axis), Rotation::ofAngles(a)(axis));
  }
}

TEST(Rotation, LookingStraightUpOrDownHasNoRoll) {
  for (const double pitch : {90., -90.}) {
    const Rotation up = Rotation::ofAngles({20, pitch, 30});
    EXPECT_EQ(up.angles().roll, 0);
    EXPECT_NEAR(up.angles().pitch, pitch, 1e-6);
    const Rotation again = Rotation::ofAngles(up.angles());
    for (const dvec3& axis : {kX, kY, kZ}) expectNear(again(axis), up(axis), 1e-9);
  }
}

TEST(Rotation, WithoutATiltItIsAYaw) {
  EXPECT_FALSE(Rotation::ofAngles({725, 0, 0}).isTilted());
  EXPECT_EQ(Rotation::ofAngles({725, 0, 0}).yaw(), 725);
  const Rotation yaw = Rotation::ofQuaternion(glm::angleAxis(glm::radians(-50.), kY));
  EXPECT_FALSE(yaw.isTilted());
  EXPECT_NEAR(yaw.yaw(), -50, 1e-5);
  EXPECT_TRUE(Rotation::ofAngles({0, 1e-4, 0}).isTilted());
}

TEST(Rotation, BackInvertsIt) {
  for (int i = 0; i < 100; ++i) {
    const Rotation rotation = Rotation::ofAngles(randomAngles(i));
    const vec3 d = glm::normalize(vec3(random1(i, 3), random1(i, 4), -0.5f));
    EXPECT_LT(glm::length(rotation.back(rotation(d)) - d), 1e-6f);
    expectNear(dvec3(rotation(d)), rotation(dvec3(d)), 1e-6);
  }
}

TEST(Rotation, BetweenYawsTheAngleIsLinearElseTheWayIsShortest) {
  EXPECT_EQ(between(-90, 630, 0.25), Rotation(90));
  const Rotation from = Rotation::ofAngles({0, 0, 20}), to = Rotation::ofAngles({0, 0, -40});
  EXPECT_NEAR(between(from, to, 0.25).angles().roll, 5, 1e-9);
  const Rotation far = Rotation::ofAngles({350, 10, 0});
  EXPECT_NEAR(between(Rotation(10), far, 0.5).angles().yaw, 0, 1) << "not by way of 180 degrees";
  EXPECT_NEAR(between(Rotation(10), far, 1).angles().yaw, -10, 1e-9);
}

TEST(Rotation, RejectsWhatIsNone) {
  EXPECT_THROW(Rotation(NAN), InputError);
  EXPECT_THROW(Rotation::ofAngles({0, INFINITY, 0}), InputError);
  EXPECT_THROW(Rotation::ofQuaternion(dquat(0, 0, 0, 0)), InputError);
}

}  // namespace
}  // namespace chromeball::rotation_test
