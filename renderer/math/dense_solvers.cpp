// SPDX-License-Identifier: Apache-2.0
#include "math/dense_solvers.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>

#include "base/progress.h"

namespace chromeball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
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

// Relative to the diagonal of A: keeps the matrix regular if two lights have the same direction.
constexpr double kActiveSetRidge = 1e-13;
constexpr double kTolerance = 1e-11;  // of the largest |b|

// The minimum over the unknowns `free`, with the others at zero.
VectorXd solveFree(const MatrixXd& A, const VectorXd& b, const std::vector<Index>& free) {
  MatrixXd block = A(free, free);
  block.diagonal() *= 1 + kActiveSetRidge;
  return block.llt().solve(b(free));
}

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

std::vector<double> solveNonnegative(std::span<const double> A, std::span<const double> b,
                                     std::span<const double> start) {
  const Index n = Index(b.size());
  // A is symmetric, so the storage order does not matter.
  const MatrixXd matrix = Eigen::Map<const MatrixXd>(A.data(), n, n);
  const VectorXd right = Eigen::Map<const VectorXd>(b.data(), n);
  VectorXd x = Eigen::Map<const VectorXd>(start.data(), n);
  std::vector<Index> free;
  for (Index i = 0; i < n; ++i)
    if (x[i] > 0) free.push_back(i);

  const double tolerance = n > 0 ? kTolerance * right.cwiseAbs().maxCoeff() : 0;
  // Each round frees one unknown. The limit ends cycles caused by rounding near the minimum.
  for (Index round = 0; round <= 3 * n; ++round) {
    endIfCancelled();
    while (!free.empty()) {
      const VectorXd target = solveFree(matrix, right, free);
      // Step until the first unknown reaches zero, and fix it there.
      double step = 1;
      Index blocked = -1;
      for (size_t k = 0; k < free.size(); ++k) {
        const double from = x[free[k]];
        if (target[k] > 0 || from / (from - target[k]) >= step) continue;
        step = from / (from - target[k]);
        blocked = free[k];
      }
      for (size_t k = 0; k < free.size(); ++k)
        x[free[k]] = std::max(0.0, x[free[k]] + step * (target[k] - x[free[k]]));
      if (blocked < 0) break;
      x[blocked] = 0;
      std::erase(free, blocked);
    }
    VectorXd slope = right - matrix * x;
    for (Index i : free) slope[i] = 0;
    Index steepest = 0;
    if (n == 0 || slope.maxCoeff(&steepest) <= tolerance) break;
    free.insert(std::upper_bound(free.begin(), free.end(), steepest), steepest);
  }
  return {x.begin(), x.end()};
}

}  // namespace chromeball
