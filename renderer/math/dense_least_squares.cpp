// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>

#include "math/dense_solvers.h"

namespace chromeball {

Eigen::VectorXd solveLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

}  // namespace chromeball
