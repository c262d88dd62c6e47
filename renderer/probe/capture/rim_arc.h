// SPDX-License-Identifier: Apache-2.0
// The pixels around a short arc of a ball's outline, and how likely they make its position.
#pragma once

#include <array>
#include <vector>

#include "image/image.h"
#include "math/vec.h"
#include "probe/capture/photograph.h"

namespace chromeball {

// How radiance changes across the outline. At the distance d from it and t along it, in pixels, it
// is b0 + b1 d + b2 t outside and a0 + a1 s + a2 s^2 + a3 t inside, where s = sqrt(-d): the cosine
// of the angle of incidence on the ball, and with it the reflected radiance and the Fresnel
// reflectance, is a smooth function of s. The reflected scene is compressed towards the rim. A
// pixel shows the mean over its square, blurred by a Gaussian. (This is the slanted edge of ISO
// 12233, with a model of the inside.)
//
// Every surface reflects all light at grazing angles, where that light comes from just behind the
// ball: so a rim that continues the background has a0 = b0.
//
// Errors are normal. Their variances differ on both sides of the outline, so that a pattern behind
// the ball hides less of a smooth reflection, and reflected lamps less of a smooth background;
// without noise, one variance is more robust.
struct RimModel {
  double blur = 0;  // standard deviation, in pixels
  bool isContinuous = false;
  bool hasOneVariance = false;
};

class RimArc {
 public:
  // Reads the pixels within `halfAngle` of `angle` (radians) that are at most kRimDepth from the
  // outline when that is at most `reach` from the circle; pixels.
  static constexpr double kRimDepth = 4;
  RimArc(const Image& image, const Circle& circle, double angle, double halfAngle, double reach);

  const glm::dvec2& normal() const { return normal_; }
  size_t pixels() const { return pixels_.size(); }

  // Minus the logarithm of the likelihood of the outline at `offset` from the circle, outwards,
  // with the most likely unknowns of the model.
  double doubt(const RimModel& model, double offset) const;

 private:
  struct Pixel {
    glm::dvec3 radiance;
    double distance, along;  // of its centre: from the circle, outwards, and from the arc's middle
  };
  glm::dvec2 normal_;
  std::vector<Pixel> pixels_;
  double meanSquare_ = 0;  // of radiance
};

// Weighted least squares of three channels that share their rows: the few unknowns of a RimModel.

using RimRow = std::array<double, 7>;

class RimEquations {
 public:
  // Rows count with their first `unknowns` numbers.
  explicit RimEquations(size_t unknowns) : unknowns_(unknowns) {}

  void add(const RimRow& row, const glm::dvec3& target, double weight) {
    for (size_t i = 0; i < unknowns_; ++i) {
      for (size_t j = 0; j <= i; ++j) matrix_[i][j] += weight * row[i] * row[j];
      right_[i] += weight * row[i] * target;
    }
  }

  // Solves the normal equations by Cholesky factors, in place; false if they are singular.
  bool solve() {
    constexpr double kSingular = 1e-9;
    for (size_t i = 0; i < unknowns_; ++i) {
      const double diagonal = matrix_[i][i];
      for (size_t j = 0; j <= i; ++j) {
        double sum = matrix_[i][j];
        for (size_t k = 0; k < j; ++k) sum -= matrix_[i][k] * matrix_[j][k];
        if (j < i)
          matrix_[i][j] = sum / matrix_[j][j];
        else if (sum > kSingular * diagonal)
          matrix_[i][i] = std::sqrt(sum);
        else
          return false;
      }
      for (size_t k = 0; k < i; ++k) right_[i] -= matrix_[i][k] * right_[k];
      right_[i] /= matrix_[i][i];
    }
    for (size_t i = unknowns_; i-- > 0;) {
      for (size_t k = i + 1; k < unknowns_; ++k) right_[i] -= matrix_[k][i] * right_[k];
      right_[i] /= matrix_[i][i];
    }
    return true;
  }

  // The value of the solution for a row.
  glm::dvec3 at(const RimRow& row) const {
    glm::dvec3 sum(0);
    for (size_t i = 0; i < unknowns_; ++i) sum += row[i] * right_[i];
    return sum;
  }

 private:
  size_t unknowns_;
  std::array<RimRow, 7> matrix_{};
  std::array<glm::dvec3, 7> right_{};
};

}  // namespace chromeball
