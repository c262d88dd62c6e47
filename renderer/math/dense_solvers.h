// SPDX-License-Identifier: Apache-2.0
// Decompositions of dense matrices of doubles by Eigen, which take seconds to compile: here once,
// in a file each of dense_*.cpp.
#pragma once

#include <Eigen/Core>

namespace chromeball {

// Of a symmetric matrix: ascending eigenvalues, and unit eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix);

// J^T J.
Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& jacobian);

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix);

// x of matrix x = right, of a symmetric matrix that is positive or negative semidefinite.
Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

// x with the least |matrix x - right|.
Eigen::VectorXd solveLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

}  // namespace chromeball
