// SPDX-License-Identifier: Apache-2.0
#include "lighting/luminance_field.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

constexpr int kColumns = 32, kRows = 16;  // of blocks, at most

int ceilDivide(int a, int b) { return (a + b - 1) / b; }

// Inverts the running sums over [begin, end]: returns the index i with sums[i] <= target <
// sums[i + 1], where target is the fraction `u` of the way from the first sum to the last. `u`
// becomes the position in that interval, in [0, 1).
int invertSums(const double* sums, int begin, int end, double& u) {
  const double target = sums[begin] + u * (sums[end] - sums[begin]);
  const double* above = std::upper_bound(sums + begin + 1, sums + end, target);
  u = std::clamp((target - above[-1]) / (above[0] - above[-1]), 0.0, 0x1.fffffffffffffp-1);
  return int(above - sums) - 1;
}

}  // namespace

BlockedField::BlockedField(const Probe& probe)
    : probe_(&probe),
      field_(probe),
      blockWidth_(ceilDivide(probe.width(), kColumns)),
      blockHeight_(ceilDivide(probe.cellRows(), kRows)),
      columns_(ceilDivide(probe.width(), blockWidth_)),
      rows_(ceilDivide(probe.cellRows(), blockHeight_)),
      columnSums_(size_t(columns_) * (probe.cellRows() + 1)),
      rowSums_(size_t(probe.cellRows()) * (probe.width() + 1)) {
  const int height = probe.cellRows(), width = probe.width();
  parallelFor(0, height, [&](int row) {
    double* sums = &rowSums_[size_t(row) * (width + 1)];
    for (int x = 0; x < width; ++x) sums[x + 1] = sums[x] + field_.integral(x, row);
  });
  for (int column = 0; column < columns_; ++column) {
    const Span span = columnsOf(column);
    double* sums = &columnSums_[size_t(column) * (height + 1)];
    for (int row = 0; row < height; ++row) {
      const double* left = &rowSums_[size_t(row) * (width + 1)];
      sums[row + 1] = sums[row] + (left[span.end] - left[span.begin]);
    }
    total_ += sums[height];
  }
  if (total_ > 0) scale_ = float(1 / (total_ * field_.jacobian()));
}

BlockedField::Span BlockedField::rowsOf(int block) const {
  const int begin = block / columns_ * blockHeight_;
  return {begin, std::min(begin + blockHeight_, probe_->cellRows())};
}

BlockedField::Span BlockedField::columnsOf(int block) const {
  const int begin = block % columns_ * blockWidth_;
  return {begin, std::min(begin + blockWidth_, probe_->width())};
}

double BlockedField::integral(int block) const {
  const double* sums = &columnSums_[size_t(block % columns_) * (probe_->cellRows() + 1)];
  const Span rows = rowsOf(block);
  return sums[rows.end] - sums[rows.begin];
}

LuminanceField::Point BlockedField::sample(int block, double u, double v) const {
  const Span rows = rowsOf(block), columns = columnsOf(block);
  const int row = invertSums(&columnSums_[size_t(block % columns_) * (probe_->cellRows() + 1)],
                             rows.begin, rows.end, v);
  const int column =
      invertSums(&rowSums_[size_t(row) * (probe_->width() + 1)], columns.begin, columns.end, u);
  return field_.sample(column, row, float(u), float(v));
}

std::vector<vec3> BlockedField::directions(int block) const {
  constexpr int kSide = 4;
  const Span rows = rowsOf(block), columns = columnsOf(block);
  std::vector<vec3> result;
  for (int i = 0; i < kSide * kSide; ++i) {
    const float x = float(columns.begin) +
                    float(columns.end - columns.begin) * (float(i % kSide) + 0.5f) / kSide;
    const float y =
        float(rows.begin) + float(rows.end - rows.begin) * (float(i / kSide) + 0.5f) / kSide;
    Probe::Position p{std::min(int(x), columns.end - 1), std::min(int(y), rows.end - 1)};
    p.s = x - float(p.column), p.t = y - float(p.row);
    result.push_back(probe_->direction(p));
  }
  return result;
}

}  // namespace chromeball
