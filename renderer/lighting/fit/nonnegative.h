// SPDX-License-Identifier: Apache-2.0
// Least squares with unknowns that may not be negative.
#pragma once

#include <span>
#include <vector>

namespace chromeball {

// The x >= 0 that minimises x . A x / 2 - b . x, for A symmetric and positive (semi)definite, row
// by row: the normal equations of a least-squares problem. Active sets (Lawson and Hanson 1974),
// begun at `guess` >= 0; the closer the guess's zeros, the fewer steps.
std::vector<double> solveNonnegative(std::span<const double> A, std::span<const double> b,
                                     std::span<const double> guess);

}  // namespace chromeball
