// SPDX-License-Identifier: Apache-2.0
// Sampling an index in proportion to tabulated weights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// Cumulative distributions of many rows of equal length, side by side, in double: a weight of 1e12
// leaves the entries after it their width. A guide table of kGuide entries a row (Chen and Asau
// 1974) leaves a step or two of search.
class CdfRows {
 public:
  CdfRows(int rows, int columns);

  // Sets a row from its weights (>= 0, finite) and returns their sum. A row of zeros is never to be
  // sampled. Rows may be set concurrently.
  double setRow(int row, std::span<const double> weights);

  // The column whose interval holds u (in [0, 1)); `u` becomes the position inside it, in [0, 1).
  // Columns of zero weight are never returned.
  int sample(int row, double& u) const {
    const double* cdf = &cdf_[size_t(row) * (columns_ + 1)];
    const int32_t* guide = &guide_[size_t(row) * (kGuide + 1) + int(u * kGuide)];
    int i = guide[0];
    for (int last = guide[1]; last - i > 8;) {
      const int middle = (i + last) / 2;
      (cdf[middle] <= u ? i : last) = middle;
    }
    while (cdf[i + 1] <= u) ++i;
    u = (u - cdf[i]) / (cdf[i + 1] - cdf[i]);
    return i;
  }

 private:
  static constexpr int kGuide = 256;
  int columns_;
  std::vector<double> cdf_;     // rows x (columns + 1), each from 0 to 1
  std::vector<int32_t> guide_;  // rows x (kGuide + 1): the column that holds k / kGuide
};

}  // namespace chromeball
