// SPDX-License-Identifier: Apache-2.0
// Sampling an index in proportion to tabulated weights.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// Cumulative distributions of many rows of equal length. In double, so that entries after a weight
// of 1e12 keep their width. A guide table for each row (Chen and Asau 1974) leaves one or
// two steps of search.
class CdfRows {
 public:
  static constexpr int kGuide = 256;

  // `guide`: entries of the guide table of a row; a search takes about columns / guide steps.
  CdfRows(int rows, int columns, int guide = kGuide);

  // Sets a row from its weights (>= 0, finite) and returns their sum. A row of zeros must not be
  // sampled. Different rows may be set concurrently.
  double setRow(int row, std::span<const double> weights);

  // The distribution of a row: columns + 1 numbers, from 0 to 1; all 0 for a row of zeros.
  std::span<const double> row(int row) const {
    return std::span(cdf_).subspan(size_t(row) * (columns_ + 1), size_t(columns_) + 1);
  }

  // For each of `guide` equal parts of [0, 1): the column that contains its beginning; and the last
  // column that has weight.
  std::span<const int32_t> guide(int row) const {
    return std::span(guide_).subspan(size_t(row) * size_t(guideSize_ + 1), size_t(guideSize_) + 1);
  }

  // The column whose interval contains u, which is in [0, 1); `u` becomes the position inside that
  // interval, in [0, 1). Never returns a column of zero weight.
  int sample(int row, double& u) const {
    const double* cdf = &cdf_[size_t(row) * (columns_ + 1)];
    const int32_t* range = guide(row, u);
    int i = range[0];
    for (int last = range[1]; last - i > 8;) {
      const int middle = (i + last) / 2;
      (cdf[middle] <= u ? i : last) = middle;
    }
    while (cdf[i + 1] <= u) ++i;
    u = (u - cdf[i]) / (cdf[i + 1] - cdf[i]);
    return i;
  }

 private:
  const int32_t* guide(int row, double u) const {
    return &guide_[size_t(row) * size_t(guideSize_ + 1) + size_t(u * guideSize_)];
  }
  int columns_, guideSize_;
  std::vector<double> cdf_;     // rows x (columns + 1), each from 0 to 1
  std::vector<int32_t> guide_;  // rows x (guideSize_ + 1): the column that contains k / guideSize_
};

// The same for numbers that are 32-bit fractions, in half the memory: a column ends at the largest
// fraction that CdfRows would find in it, so that both find the same columns.
class FractionCdfRows {
 public:
  FractionCdfRows(int rows, int columns);

  double setRow(int row, std::span<const double> weights);  // as CdfRows

  // These fetch into the cache what sample() reads: first its range of columns, then their ends.
  void prefetchGuide(int row, uint32_t u) const { __builtin_prefetch(guide(row, u)); }
  void prefetchEnds(int row, uint32_t u) const { __builtin_prefetch(ends(row) + *guide(row, u)); }

  // The column whose interval contains u; `within` is the position inside the interval, in [0, 1].
  int sample(int row, uint32_t u, float& within) const;

 private:
  static constexpr int kAtOnce = 8;
  static constexpr int kGuideBits = 8;
  static constexpr size_t kGuide = size_t(1) << kGuideBits;

  const int32_t* guide(int row, uint32_t u) const {
    return &guide_[size_t(row) * (kGuide + 1) + (u >> (32 - kGuideBits))];
  }

  size_t stride() const { return size_t(columns_) + kAtOnce - 1; }
  const uint32_t* ends(int row) const { return &ends_[size_t(row) * stride()]; }

  int columns_;
  // By row and column: the largest fraction of the column. Each row goes on with the largest number
  // of all, for comparisons of kAtOnce.
  std::vector<uint32_t> ends_;
  std::vector<int32_t> guide_;  // rows x (kGuide + 1), as of CdfRows
};

// The number that `fraction` of the others, 0 to 1, are below: one of `values`, which are not
// empty.
template <class T>
T quantile(std::vector<T> values, double fraction) {
  assert(!values.empty());
  const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class T>
T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace chromeball
