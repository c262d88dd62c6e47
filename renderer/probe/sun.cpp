// SPDX-License-Identifier: Apache-2.0
#include "probe/sun.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

double sinOfRadius(const Sun& sun) { return std::sin(sun.angle * (kPiD / 360)); }

}  // namespace

glm::dvec3 Sun::radiance() const {
  const double sine = sinOfRadius(*this);
  return irradiance / (kPiD * sine * sine);
}

// Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering" (2014), the function
// illuminanceSphereOrDisk.
glm::dvec3 Sun::irradianceOn(const glm::dvec3& normal) const {
  const double cosine = glm::dot(normal, direction), sinRadius = sinOfRadius(*this);
  if (cosine >= sinRadius) return irradiance * cosine;
  if (cosine <= -sinRadius) return glm::dvec3(0);
  const double square = sinRadius * sinRadius, x = std::sqrt(1 / square - 1);
  const double sine = std::sqrt(1 - cosine * cosine);
  const double y = std::clamp(-x * cosine / sine, -1.0, 1.0);
  const double chord = sine * std::sqrt(1 - y * y);
  const double seen = (cosine * std::acos(y) - x * chord) * square + std::atan(chord / x);
  return irradiance * (seen / (kPiD * square));
}

}  // namespace chromeball
