// SPDX-License-Identifier: Apache-2.0
#include "math/dense_solvers.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace chromeball {

SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularVectors singularVectors(const Eigen::MatrixXd& matrix) {
  const auto svd = matrix.jacobiSvd(Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace chromeball
