// SPDX-License-Identifier: Apache-2.0
#include "probe/arc_integrals.h"

namespace chromeball {
namespace {

// The azimuth a turned by b.
Azimuth turned(const Azimuth& a, const Azimuth& b) {
  double phi = a.phi + b.phi;
  if (phi >= 2 * kPiD) phi -= 2 * kPiD;
  return {phi, a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}

}  // namespace

Horizon::Horizon(const vec3& normal)
    : normal_(normal), azimuth_{0, 1, 0}, horizontal_(std::hypot(normal_.x, normal_.z)) {
  if (!(horizontal_ > 0)) return;
  const double phi = std::atan2(-normal_.x, normal_.z);
  azimuth_ = {phi < 0 ? phi + 2 * kPiD : phi, normal_.z / horizontal_, -normal_.x / horizontal_};
}

// sine horizontal cos(phi - azimuth) + cosine normal.y > 0.
Arc Horizon::above(double sine, double cosine) const {
  const double across = sine * horizontal_, up = cosine * normal_.y;
  if (up >= across) return {up > 0 ? Arc::Kind::Whole : Arc::Kind::Empty};
  if (-up >= across) return {};
  const double cosHalf = -up / across, half = std::acos(cosHalf);
  const double sinHalf = std::sqrt((1 - cosHalf) * (1 + cosHalf));
  return {Arc::Kind::Part, turned(azimuth_, {2 * kPiD - half, cosHalf, -sinHalf}),
          turned(azimuth_, {half, cosHalf, sinHalf})};
}

// Without cancellation for flat rows.
PolarMoments::PolarMoments(double theta0, double theta1) {
  const double sum = theta0 + theta1, height = theta1 - theta0;
  sine2 = (height - std::sin(height) * std::cos(sum)) / 2;
  sineCosine = std::sin(sum) * std::sin(height) / 2;
}

}  // namespace chromeball
