// SPDX-License-Identifier: Apache-2.0
// Dense matrices of doubles by Eigen, and least squares of all kinds. Decompositions take seconds
// to compile: each is compiled once, here.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <utility>
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

// Non-negative least squares.

// The x >= 0 that minimises x . A x / 2 - b . x, where A (n x n) is symmetric and positive
// (semi)definite: the normal equations of a least-squares problem. The active-set method of Lawson
// and Hanson (1974), started from `start` >= 0; the fewer of its zeros differ from the solution's,
// the fewer steps it takes.
std::vector<double> solveNonnegative(std::span<const double> A, std::span<const double> b,
                                     std::span<const double> start);

// Nonlinear least squares by the Levenberg-Marquardt method (Marquardt 1963).

template <class State>
struct Minimum {
  State state;
  double squares = 0;      // the sum of the squared residuals
  Eigen::MatrixXd normal;  // J^T J there
};

// Descends from `start`, which must be in the problem's domain. A problem has a type State, and
//   bool residuals(const State&, Eigen::VectorXd&, Eigen::MatrixXd* jacobian) const
//                                              false outside of its domain; jacobian may be null
//   State moved(const State&, const Eigen::VectorXd& step) const
// The Jacobian is the derivative of residuals(moved(state, step)) at the step 0. Stops after
// `maxSteps`, or when a step changes nothing.
template <class Problem>
Minimum<typename Problem::State> minimise(const Problem& problem, typename Problem::State start,
                                          int maxSteps) {
  constexpr double kFirst = 1e-3, kLess = 0.1, kMore = 10, kMost = 1e12, kStill = 1e-14;
  Minimum<typename Problem::State> best{std::move(start), 0, {}};
  Eigen::VectorXd residual, other;
  Eigen::MatrixXd jacobian;
  problem.residuals(best.state, residual, &jacobian);
  best.squares = residual.squaredNorm();
  double damping = kFirst;
  for (int step = 0; step < maxSteps && damping < kMost; ++step) {
    best.normal = normalMatrix(jacobian);
    Eigen::MatrixXd damped = best.normal;
    damped.diagonal() *= 1 + damping;
    const Eigen::VectorXd move = solveSymmetric(damped, -jacobian.transpose() * residual);
    typename Problem::State moved = problem.moved(best.state, move);
    if (!move.allFinite() || !problem.residuals(moved, other, nullptr) ||
        !(other.squaredNorm() <= best.squares)) {
      damping *= kMore;
      continue;
    }
    const double gain = best.squares - other.squaredNorm();
    best.state = std::move(moved);
    problem.residuals(best.state, residual, &jacobian);
    best.squares = residual.squaredNorm();
    damping *= kLess;
    if (gain <= kStill * best.squares) break;
  }
  best.normal = normalMatrix(jacobian);
  return best;
}

}  // namespace chromeball
