// SPDX-License-Identifier: Apache-2.0
// The luminance field divided into blocks of cells that can be sampled separately.
#pragma once

#include <vector>

#include "lighting/luminance_field.h"

namespace chromeball {

// At most 32 x 16 blocks. All blocks share the running sums along rows of cells and along columns
// of blocks.
class BlockedField {
 public:
  explicit BlockedField(const Probe& probe);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  int blocks() const { return rows_ * columns_; }
  int blockOf(const Probe::Position& p) const {
    return p.row / blockHeight_ * columns_ + p.column / blockWidth_;
  }

  // The integral of the field's weight over a block, and over the whole field.
  double integral(int block) const;
  double total() const { return total_; }

  // A point of a block with integral > 0, with pdf proportional to the field's weight, from two
  // numbers in [0, 1).
  LuminanceField::Point sample(int block, double u, double v) const;
  LuminanceField::Point at(const vec3& direction, const Probe::Position& p) const {
    return field_.at(direction, p);
  }

  // Factor from a point's weight to its pdf over solid angle, when sampling the whole field.
  float scale() const { return scale_; }

  // 16 directions spread over a block.
  std::vector<vec3> directions(int block) const;

 private:
  struct Span {
    int begin, end;
  };
  Span rowsOf(int block) const;
  Span columnsOf(int block) const;

  const Probe* probe_;
  LuminanceField field_;
  int blockWidth_, blockHeight_, columns_, rows_;
  std::vector<double> columnSums_;  // for each column of blocks, over its cells in the rows above
  std::vector<double> rowSums_;     // for each row of cells, over the cells to the left
  double total_ = 0;
  float scale_ = 0;
};

}  // namespace chromeball
