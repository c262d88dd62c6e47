// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "math/dense_solvers.h"

namespace chromeball {

Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& jacobian) {
  return jacobian.transpose() * jacobian;
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix) { return matrix.inverse(); }

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

}  // namespace chromeball
