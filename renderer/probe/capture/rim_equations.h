// SPDX-License-Identifier: Apache-2.0
// Weighted least squares of three channels that share their rows: the few unknowns of a RimModel.
#pragma once

#include <array>

#include "math/vec.h"

namespace chromeball {

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

  // Of the normal equations, by Cholesky's factors, in place; false if they are singular.
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

  // What the solution makes of a row.
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
