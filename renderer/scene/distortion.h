// SPDX-License-Identifier: Apache-2.0
// Radial distortion of a lens.
#pragma once

namespace chromeball {

// The point (x, y) of the plane at distance 1 in front of the lens appears where a pinhole would
// show (1 + k1 r^2 + k2 r^4) (x, y), with r^2 = x^2 + y^2 (Brown 1971, the radial terms; the
// coefficients of OpenCV). Negative k1 is a barrel. A radius is that of a point in this plane,
// before (undistorted) or after (distorted) the lens.
struct Distortion {
  double k1 = 0, k2 = 0;

  explicit operator bool() const { return k1 != 0 || k2 != 0; }
  bool operator==(const Distortion&) const = default;

  double factor(double r2) const { return 1 + r2 * (k1 + r2 * k2); }
  double distorted(double radius) const { return radius * factor(radius * radius); }
  // The derivative of distorted().
  double slope(double radius) const {
    const double r2 = radius * radius;
    return 1 + r2 * (3 * k1 + r2 * 5 * k2);
  }

  // The undistorted radius at which the picture folds back: distorted() ascends up to there.
  // Infinite if it always ascends.
  double fold() const;

  // Whether one point, and no other before the fold, appears at this distorted radius.
  bool reaches(double radius) const { return radius < distortedFold(); }

  // The inverse of distorted() before the fold; the fold if no point appears at `radius`.
  double undistorted(double radius) const;

 private:
  double distortedFold() const;
};

}  // namespace chromeball
