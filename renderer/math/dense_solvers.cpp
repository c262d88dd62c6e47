// SPDX-License-Identifier: Apache-2.0
#include "math/dense_solvers.h"

#include <Eigen/Dense>

namespace chromeball {

SymmetricEigen eigenOfSymmetric(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularVectors singularVectors(const Eigen::MatrixXd& matrix) {
  const auto svd = matrix.jacobiSvd(Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixV()};
}

Eigen::MatrixXd normalMatrix(const Eigen::MatrixXd& jacobian) {
  return jacobian.transpose() * jacobian;
}

Eigen::MatrixXd inverseOf(const Eigen::MatrixXd& matrix) { return matrix.inverse(); }

Eigen::VectorXd solveSymmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::VectorXd solveLeastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

}  // namespace chromeball
