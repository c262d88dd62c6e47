// SPDX-License-Identifier: Apache-2.0
#include "scene/distortion.h"

#include <cmath>
#include <initializer_list>
#include <limits>

namespace chromeball {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The smallest positive root of 1 + b t + a t^2; infinite if there is none.
double firstRoot(double a, double b) {
  const double discriminant = b * b - 4 * a;
  if (discriminant < 0) return kInfinity;
  // The product of the roots is 1 / a, so that neither needs a difference of like numbers.
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  double first = kInfinity;
  for (const double root : {q / a, 1 / q})
    if (root > 0 && root < first) first = root;
  return first;
}

}  // namespace

double Distortion::fold() const { return std::sqrt(firstRoot(5 * k2, 3 * k1)); }

double Distortion::distortedFold() const {
  const double radius = fold();
  return std::isinf(radius) ? radius : distorted(radius);
}

// Newton's method, and bisection where it leaves the interval that holds the root.
double Distortion::undistorted(double radius) const {
  constexpr int kMaxSteps = 100;
  double low = 0, high = fold();
  if (!reaches(radius)) return high;
  if (std::isinf(high))
    for (high = radius; distorted(high) < radius;) high *= 2;
  double r = radius < high ? radius : 0.5 * high;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double excess = distorted(r) - radius;
    (excess > 0 ? high : low) = r;
    double next = r - excess / slope(r);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - r) <= 1e-15 * r) return next;
    r = next;
  }
  return r;
}

}  // namespace chromeball
