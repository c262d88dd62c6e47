// SPDX-License-Identifier: Apache-2.0
// Rotations of an environment, such as a probe.
#pragma once

#include <vector>

#include "math/vec.h"

namespace chromeball {

// Counter-clockwise seen from above.
inline glm::dvec3 turnedAboutY(const glm::dvec3& d, double degrees) {
  const double angle = degrees * kPiD / 180, sine = std::sin(angle), cosine = std::cos(angle);
  return {d.x * cosine + d.z * sine, d.y, d.z * cosine - d.x * sine};
}

// What an environment shows in direction d is seen in direction R d after the rotation. R is first
// a roll about +Z, then a pitch about +X, then a yaw about +Y, of fixed axes and each
// counter-clockwise seen from the tip of its axis: R = Ry(yaw) Rx(pitch) Rz(roll). So roll lifts
// the right of a map whose centre is -Z, pitch lifts its centre, and yaw moves that to the left: a
// camera's roll, tilt and pan.
class Rotation {
 public:
  struct Angles {
    double yaw, pitch, roll;  // degrees
  };

  // A rotation about +Y alone. The constructors throw InputError if a number is not finite.
  Rotation(float yawDegrees = 0);
  static Rotation ofAngles(const Angles& angles);
  // From a quaternion of any length but 0; throws InputError for 0. Without a tilt it is a yaw.
  static Rotation ofQuaternion(const glm::dquat& quaternion);

  // Whether it is more than a yaw.
  bool isTilted() const { return isTilted_; }
  float yaw() const { return yaw_; }  // degrees; without a tilt as given
  // Yaw and roll from -180 to 180 degrees, pitch from -90 to 90; roll is 0 if pitch is -90 or 90.
  Angles angles() const;
  glm::dquat quaternion() const { return exact_; }
  // The yaw, or with a tilt the quaternion's x, y, z, w.
  std::vector<double> numbers() const;

  glm::dvec3 operator()(const glm::dvec3& d) const {
    return isTilted_ ? exact_ * d : turnedAboutY(d, double(yaw_));
  }
  vec3 operator()(const vec3& d) const { return turn_ * d; }
  vec3 back(const vec3& d) const { return glm::conjugate(turn_) * d; }

  bool operator==(const Rotation& other) const {
    return yaw_ == other.yaw_ && exact_ == other.exact_;
  }

 private:
  float yaw_;
  bool isTilted_ = false;
  glm::dquat exact_;
  glm::quat turn_;
};

// The rotation at `t` in [0, 1] from one to another: between yaws linear in their angle, so that
// more than a turn is possible, else the shortest way at constant speed.
Rotation between(const Rotation& from, const Rotation& to, double t);

// The given number of rotations with no large gap between them: a super-Fibonacci spiral of unit
// quaternions (Alexa 2022).
std::vector<glm::dmat3> spreadRotations(int count);

// The rotation about `axis` by its length in radians.
glm::dmat3 rotationBy(const glm::dvec3& axis);

// The angle between two rotations, in radians.
double angleBetween(const glm::dmat3& a, const glm::dmat3& b);

}  // namespace chromeball
