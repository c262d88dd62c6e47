// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/ball_reflectance.h"

#include <complex>

namespace chromeball {

double metalFresnel(double cosIncidence, const MetalIndex& index) {
  using Complex = std::complex<double>;
  const double c = std::clamp(cosIncidence, 0.0, 1.0);
  const Complex eta(index.n, index.k);
  const Complex inside = std::sqrt(eta * eta - (1 - c * c));  // eta times the cosine in the metal
  const Complex across = (c - inside) / (c + inside);
  const Complex along = (eta * eta * c - inside) / (eta * eta * c + inside);
  return 0.5 * (std::norm(across) + std::norm(along));
}

BallReflectance BallReflectance::ofMetal(const glm::dvec3& normal, const MetalIndex& index) {
  BallReflectance reflectance(normal);
  reflectance.index_ = index;
  return reflectance;
}

BallReflectance BallReflectance::schlick(const glm::dvec3& normal) {
  BallReflectance reflectance(normal);
  reflectance.isSchlick_ = true;
  return reflectance;
}

glm::dvec3 BallReflectance::at(double cosIncidence) const {
  if (index_) return normal_ * (metalFresnel(cosIncidence, *index_) / metalFresnel(1, *index_));
  if (isSchlick_)
    return normal_ + (1.0 - normal_) * std::pow(std::clamp(1 - cosIncidence, 0.0, 1.0), 5);
  return normal_;
}

}  // namespace chromeball
