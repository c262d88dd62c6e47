// SPDX-License-Identifier: Apache-2.0
#include "math/least_squares.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace chromeball {

LeastSquares::LeastSquares(int unknowns)
    : unknowns_(unknowns), matrix_(size_t(unknowns) * unknowns), right_(size_t(unknowns)) {}

void LeastSquares::add(std::span<const Term> row, double target, double weight) {
  for (const Term& a : row) {
    for (const Term& b : row)
      if (b.unknown <= a.unknown)
        matrix_[size_t(a.unknown) * unknowns_ + b.unknown] +=
            weight * a.coefficient * b.coefficient;
    right_[size_t(a.unknown)] += weight * a.coefficient * target;
  }
}

// Scaled to a unit diagonal, so that the pivots tell whether an unknown depends on the others.
std::optional<std::vector<double>> LeastSquares::solve() const {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  constexpr double kLeastPivot = 1e-13;
  const Eigen::Map<const Matrix> matrix(matrix_.data(), unknowns_, unknowns_);
  const Eigen::Map<const Eigen::VectorXd> right(right_.data(), unknowns_);
  if (!(matrix.diagonal().minCoeff() > 0)) return std::nullopt;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::LDLT<Matrix, Eigen::Lower> factors(scaled);
  if (!(factors.vectorD().minCoeff() > kLeastPivot)) return std::nullopt;
  const Eigen::VectorXd solution = scale.cwiseProduct(factors.solve(scale.cwiseProduct(right)));
  return std::vector<double>(solution.begin(), solution.end());
}

}  // namespace chromeball
