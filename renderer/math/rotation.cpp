// SPDX-License-Identifier: Apache-2.0
#include "math/rotation.h"

#include "base/error.h"

namespace chromeball {
namespace {

using glm::dquat;
using glm::dvec3;

dquat about(const dvec3& axis, double degrees) {
  return glm::angleAxis(glm::radians(degrees), axis);
}

}  // namespace

Rotation::Rotation(float yawDegrees)
    : yaw_(yawDegrees),
      exact_(about({0, 1, 0}, double(yawDegrees))),
      turn_(glm::angleAxis(glm::radians(yawDegrees), vec3(0, 1, 0))) {
  if (!std::isfinite(yawDegrees))
    throwInput("the rotation {} should be a finite number of degrees", yawDegrees);
}

Rotation Rotation::ofAngles(const Angles& angles) {
  if (angles.pitch == 0 && angles.roll == 0) return Rotation(float(angles.yaw));
  return ofQuaternion(about({0, 1, 0}, angles.yaw) * about({1, 0, 0}, angles.pitch) *
                      about({0, 0, 1}, angles.roll));
}

Rotation Rotation::ofQuaternion(const dquat& quaternion) {
  const double length = glm::length(quaternion);
  if (!(length > 0) || !std::isfinite(length))
    throwInput("the rotation should be finite numbers, and a quaternion not 0");
  const dquat q = quaternion / length;
  constexpr double kLeastTilt = 1e-9;  // half of it, in radians; a direction of floats errs more
  Rotation rotation(float(glm::degrees(2 * std::atan2(q.y, q.w))));
  if (std::hypot(q.x, q.z) < kLeastTilt) return rotation;
  rotation.isTilted_ = true;
  rotation.exact_ = q;
  rotation.turn_ = glm::quat(q);
  rotation.yaw_ = float(rotation.angles().yaw);
  return rotation;
}

// R's column of +Z is (sin yaw cos pitch, -sin pitch, cos yaw cos pitch), and its row of Y is
// (cos pitch sin roll, cos pitch cos roll, -sin pitch).
Rotation::Angles Rotation::angles() const {
  const dvec3 x = exact_ * dvec3(1, 0, 0), y = exact_ * dvec3(0, 1, 0), z = exact_ * dvec3(0, 0, 1);
  constexpr double kUpright = 1e-7;  // cosine of the pitch
  const double cosine = std::hypot(z.x, z.z);
  const double pitch = glm::degrees(std::atan2(-z.y, cosine));
  if (cosine < kUpright) return {glm::degrees(std::atan2(-x.z, x.x)), pitch, 0};
  return {glm::degrees(std::atan2(z.x, z.z)), pitch, glm::degrees(std::atan2(x.y, y.y))};
}

std::vector<double> Rotation::numbers() const {
  if (!isTilted_) return {double(yaw_)};
  return {exact_.x, exact_.y, exact_.z, exact_.w};
}

Rotation between(const Rotation& from, const Rotation& to, double t) {
  if (!from.isTilted() && !to.isTilted())
    return Rotation(float(double(from.yaw()) + (double(to.yaw()) - double(from.yaw())) * t));
  return Rotation::ofQuaternion(glm::slerp(from.quaternion(), to.quaternion(), t));
}

using glm::dmat3, glm::dquat;

std::vector<dmat3> spreadRotations(int count) {
  constexpr double kPhi = 1.4142135623730951, kPsi = 1.5337511687552043;  // psi^4 = psi + 4
  std::vector<dmat3> rotations;
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5, t = s / count, a = 2 * kPiD * s / kPhi, b = 2 * kPiD * s / kPsi;
    const double inner = std::sqrt(t), outer = std::sqrt(1 - t);
    rotations.push_back(glm::mat3_cast(
        dquat(outer * std::cos(b), inner * std::sin(a), inner * std::cos(a), outer * std::sin(b))));
  }
  return rotations;
}

dmat3 rotationBy(const glm::dvec3& axis) {
  const double angle = glm::length(axis);
  return angle > 0 ? glm::mat3_cast(glm::angleAxis(angle, axis / angle)) : dmat3(1);
}

double angleBetween(const dmat3& a, const dmat3& b) {
  double trace = 0;
  for (int i = 0; i < 3; ++i) trace += glm::dot(a[i], b[i]);
  return std::acos(std::clamp(0.5 * (trace - 1), -1.0, 1.0));
}

}  // namespace chromeball
