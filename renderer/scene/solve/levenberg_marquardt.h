// SPDX-License-Identifier: Apache-2.0
// Nonlinear least squares by the Levenberg-Marquardt method (Marquardt 1963).
#pragma once

#include "math/dense_solvers.h"

namespace chromeball {

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
