// SPDX-License-Identifier: Apache-2.0
#include "math/dense_solvers.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

namespace chromeball {
namespace {

using NormalMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Scaled to a unit diagonal, so that the pivots tell whether an unknown depends on the others.
struct ScaledFactors {
  Eigen::VectorXd scale;
  Eigen::LDLT<NormalMatrix, Eigen::Lower> factors;
  bool isDefinite = false;

  explicit ScaledFactors(const NormalMatrix& matrix) {
    constexpr double kLeastPivot = 1e-13;
    if (!(matrix.diagonal().minCoeff() > 0)) return;
    scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    factors.compute(scale.asDiagonal() * matrix * scale.asDiagonal());
    isDefinite = factors.vectorD().minCoeff() > kLeastPivot;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    return scale.cwiseProduct(factors.solve(scale.cwiseProduct(right)));
  }
};

}  // namespace

Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& jacobian) {
  return jacobian.transpose() * jacobian;
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix) { return matrix.inverse(); }

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

LeastSquares::LeastSquares(int unknowns)
    : matrix_(NormalMatrix::Zero(unknowns, unknowns)), right_(Eigen::VectorXd::Zero(unknowns)) {}

void LeastSquares::add(std::span<const Term> row, double target, double weight) {
  for (const Term& a : row) {
    for (const Term& b : row)
      if (b.unknown <= a.unknown)
        matrix_(a.unknown, b.unknown) += weight * a.coefficient * b.coefficient;
    right_[a.unknown] += weight * a.coefficient * target;
  }
}

std::optional<std::vector<double>> LeastSquares::solve() const {
  const ScaledFactors scaled(matrix_);
  if (!scaled.isDefinite) return std::nullopt;
  const Eigen::VectorXd solution = scaled.solve(right_);
  return std::vector<double>(solution.begin(), solution.end());
}

std::optional<std::vector<double>> LeastSquares::variances() const {
  const ScaledFactors scaled(matrix_);
  if (!scaled.isDefinite) return std::nullopt;
  std::vector<double> diagonal;
  for (Eigen::Index i = 0; i < right_.size(); ++i)
    diagonal.push_back(scaled.solve(Eigen::VectorXd::Unit(right_.size(), i))[i]);
  return diagonal;
}

SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solveLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

}  // namespace chromeball
