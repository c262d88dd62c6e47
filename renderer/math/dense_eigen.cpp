// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>

#include "math/dense_solvers.h"

namespace chromeball {

SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace chromeball
