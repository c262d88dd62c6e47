// SPDX-License-Identifier: Apache-2.0
// Non-negative least squares.
#pragma once

#include <span>
#include <vector>

namespace chromeball {

// The x >= 0 that minimises x . A x / 2 - b . x, where A (n x n) is symmetric and positive
// (semi)definite: the normal equations of a least-squares problem. The active-set method of Lawson
// and Hanson (1974), started from `start` >= 0; the fewer of its zeros differ from the solution's,
// the fewer steps it takes.
std::vector<double> solveNonnegative(std::span<const double> A, std::span<const double> b,
                                     std::span<const double> start);

}  // namespace chromeball
