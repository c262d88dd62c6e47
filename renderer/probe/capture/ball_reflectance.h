// SPDX-License-Identifier: Apache-2.0
// How much light a mirror ball reflects.
#pragma once

#include <optional>

#include "math/vec.h"

namespace chromeball {

// Index of refraction n + ik of a metal.
struct MetalIndex {
  double n, k;
};

// The reflectance of unpolarised light by a metal in air, exactly (Born and Wolf, section 14.2).
double metalFresnel(double cosIncidence, const MetalIndex& index);

// Reflectance of linear Rec. 709 by a ball.
class BallReflectance {
 public:
  // The same at all angles.
  explicit BallReflectance(const glm::dvec3& reflectance = glm::dvec3(1)) : normal_(reflectance) {}

  // Measured at normal incidence, and changing with the angle as a metal's.
  static BallReflectance ofMetal(const glm::dvec3& normal, const MetalIndex& index);
  // The same by Schlick's approximation (1994), which rises to 1 at the rim: for rendered balls.
  static BallReflectance schlick(const glm::dvec3& normal);

  glm::dvec3 at(double cosIncidence) const;

 private:
  glm::dvec3 normal_;
  bool isSchlick_ = false;
  std::optional<MetalIndex> index_;
};

}  // namespace chromeball
