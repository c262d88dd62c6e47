// SPDX-License-Identifier: Apache-2.0
#include "math/cdf.h"

#include <cmath>
#include <limits>

#include "base/memory.h"
#include "math/lanes.h"

namespace chromeball {

CdfRows::CdfRows(int rows, int columns, int guide)
    : columns_(columns),
      guideSize_(guide),
      cdf_(longArray<double>(size_t(rows) * (columns + 1))),
      guide_(longArray<int32_t>(size_t(rows) * size_t(guide + 1))) {}

double CdfRows::setRow(int row, std::span<const double> weights) {
  assert(int(weights.size()) == columns_);
  double total = 0;
  for (double w : weights) total += w;
  double* cdf = &cdf_[size_t(row) * (columns_ + 1)];
  if (!(total > 0)) return 0;

  double sum = 0;
  int last = 0;
  for (int i = 0; i < columns_; ++i) {
    cdf[i] = sum / total;
    sum += weights[i];
    if (weights[i] > 0) last = i;
  }
  // Without this, rounding could leave a gap below 1 where a column of zero weight would be
  // sampled.
  for (int i = last + 1; i <= columns_; ++i) cdf[i] = 1;

  int32_t* const guide = &guide_[size_t(row) * size_t(guideSize_ + 1)];
  int column = 0;
  for (int k = 0; k < guideSize_; ++k) {
    while (cdf[column + 1] <= double(k) / guideSize_) ++column;
    guide[k] = column;
  }
  guide[guideSize_] = last;
  return total;
}

FractionCdfRows::FractionCdfRows(int rows, int columns)
    : columns_(columns),
      ends_(longArray<uint32_t>(size_t(rows) * stride())),
      guide_(longArray<int32_t>(size_t(rows) * (kGuide + 1))) {}

double FractionCdfRows::setRow(int row, std::span<const double> weights) {
  CdfRows exact(1, columns_, int(kGuide));
  const double total = exact.setRow(0, weights);
  const std::span<const double> cdf = exact.row(0);
  uint32_t* const of = &ends_[size_t(row) * stride()];
  for (int i = 0; i < columns_; ++i)
    of[i] = uint32_t(std::max(std::ceil(cdf[size_t(i) + 1] * 0x1p32) - 1, 0.0));
  std::fill(of + columns_, of + stride(), std::numeric_limits<uint32_t>::max());
  std::ranges::copy(exact.guide(0), &guide_[size_t(row) * (kGuide + 1)]);
  return total;
}

// Few loops end at a place that depends on u: they are mispredicted.
int FractionCdfRows::sample(int row, uint32_t u, float& within) const {
  constexpr int kSteps = 4;  // of kAtOnce columns, at most
  const uint32_t* const of = ends(row);
  const int32_t* range = guide(row, u);
  int i = range[0];
  for (int last = range[1]; last - i > kSteps * kAtOnce;) {
    const int middle = (i + last) / 2;
    of[middle - 1] < u ? i = middle : last = middle;
  }
  const Int8 own = Int8{} + int32_t(u);
  for (unsigned reached = 0; reached == 0;) {
    const Int8 end = loadLanes(reinterpret_cast<const int32_t*>(of + i));
    reached = bitsOf(Int8(_mm256_max_epu32(__m256i(end), __m256i(own))) == end);  // end >= u
    i += reached == 0 ? kAtOnce : std::countr_zero(reached);
  }
  const uint32_t begin = i > *guide(row, 0) ? of[i - 1] + 1 : 0;
  within = (float(u - begin) + 0.5f) / (float(of[i] - begin) + 1);
  return i;
}

}  // namespace chromeball
