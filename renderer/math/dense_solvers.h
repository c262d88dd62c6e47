// SPDX-License-Identifier: Apache-2.0
// Decompositions of dense matrices of doubles by Eigen, which take seconds to compile: each is
// compiled once, in a file of its own (dense_*.cpp).
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <vector>

namespace chromeball {

// The eigensystem of a symmetric matrix: ascending eigenvalues, and unit eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix);

// J^T J.
Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& jacobian);

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix);

// The x with matrix x = right, for a symmetric matrix that is positive or negative semidefinite.
Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

// The x with the least |matrix x - right|.
Eigen::VectorXd solveLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

// Linear least squares by the normal equations: for problems of few unknowns and many rows, whose
// matrix is too large to keep.

class LeastSquares {
 public:
  explicit LeastSquares(int unknowns);

  struct Term {
    int unknown;
    double coefficient;
  };
  // Adds an equation: sum of coefficient x unknown = target; its error counts `weight` (>= 0)
  // times.
  void add(std::span<const Term> row, double target, double weight = 1);

  // The unknowns with the least weighted sum of squared errors; nullopt if the equations do not
  // determine all of them. The normal equations square the condition of the problem.
  std::optional<std::vector<double>> solve() const;

  // The diagonal of the normal matrix's inverse: the variances of the unknowns where the targets of
  // the equations have independent errors of variance 1 / weight. nullopt where solve() gives
  // nullopt.
  std::optional<std::vector<double>> variances() const;

 private:
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix_;  // lower triangle
  Eigen::VectorXd right_;
};

}  // namespace chromeball
