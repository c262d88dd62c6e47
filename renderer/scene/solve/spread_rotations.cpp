// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/spread_rotations.h"

namespace chromeball {

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
