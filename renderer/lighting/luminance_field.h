// SPDX-License-Identifier: Apache-2.0
// The probe's luminance as an unnormalised, continuous pdf over its map.
#pragma once

#include <limits>
#include <vector>

#include "probe/probe.h"

namespace chromeball {

// w = max(luminance - offset, 0) x sin(theta) at the corners of the probe's cells, interpolated
// bilinearly between them; with offset 0 it is positive wherever the radiance is. The corresponding
// pdf over solid angle is w / (integral of w over the map, in cells, x jacobian x sin(theta)).
class LuminanceField {
 public:
  explicit LuminanceField(const Probe& probe, float offset = 0)
      : probe_(&probe), offset_(offset), rowSine_(probe.height() + 2) {
    for (int row = 1; row <= probe.height(); ++row)
      rowSine_[row] = float(std::sin(kPiD * (row - 0.5) / probe.height()));
    // sin(theta) is 0 at the poles, but the pdf must not be 0 there if they are lit.
    rowSine_.front() = rowSine_[1] / 8;
    rowSine_.back() = rowSine_[probe.height()] / 8;
  }

  // The integral of w over a cell, in cells of full height; those next to a pole are half as high.
  double integral(int column, int row) const {
    const Weights w = weights(probe_->corners(column, row), row);
    const bool cap = row == 0 || row == probe_->height();
    return (double(w.w00) + w.w10 + w.w01 + w.w11) * (cap ? 0.125 : 0.25);
  }

  // Radiance and weight in one direction: pdf over solid angle = weight / (sum of integrals x
  // jacobian).
  struct Point {
    vec3 direction;
    Rgb radiance;
    float weight;  // w / sin(theta)
  };
  Point at(const vec3& direction, const Probe::Position& p) const {
    const Probe::Corners corners = probe_->corners(p.column, p.row);
    return {direction, Probe::interpolate(corners, p.s, p.t),
            weights(corners, p.row).at(p.s, p.t) / std::max(p.sinTheta, 1e-9f)};
  }

  // A point of a cell with integral > 0, with pdf proportional to w, from two numbers in [0, 1).
  Point sample(int column, int row, float u, float v) const {
    const Weights w = weights(probe_->corners(column, row), row);
    Probe::Position p{column, row};
    p.t = sampleLinear(v, w.w00 + w.w10, w.w01 + w.w11);
    p.s = sampleLinear(u, (1 - p.t) * w.w00 + p.t * w.w01, (1 - p.t) * w.w10 + p.t * w.w11);
    const vec3 direction = probe_->direction(p);
    return at(direction, p);
  }

  // Solid angle = jacobian x sin(theta) x area in cells.
  double jacobian() const { return 2 * kPiD * kPiD / (double(probe_->width()) * probe_->height()); }

 private:
  struct Weights {
    float w00, w10, w01, w11;
    float at(float s, float t) const {
      return (1 - t) * ((1 - s) * w00 + s * w10) + t * ((1 - s) * w01 + s * w11);
    }
  };
  Weights weights(const Probe::Corners& c, int row) const {
    const float top = rowSine_[row], bottom = rowSine_[row + 1];
    const auto weight = [&](const Rgb& radiance) {
      return std::max(luminance(radiance) - offset_, 0.0f);
    };
    return {weight(c.c00) * top, weight(c.c10) * top, weight(c.c01) * bottom,
            weight(c.c11) * bottom};
  }

  // A number in [0, 1) with pdf proportional to a (1 - x) + b x. Divides by the greater of a and b
  // because the squares of numbers outside 1e-19..1e19 exceed the range of a float.
  static float sampleLinear(float u, float a, float b) {
    const float greater = std::max(a, b);
    if (!(greater > 0)) return u;
    a /= greater, b /= greater;
    const float root = std::sqrt(std::max(a * a + u * (b * b - a * a), 0.0f));
    return std::min(u * (a + b) / std::max(a + root, std::numeric_limits<float>::min()),
                    0x1.fffffep-1f);
  }

  const Probe* probe_;
  float offset_;
  std::vector<float> rowSine_;  // sin(theta) of the corner rows
};

// The luminance field divided into blocks of cells that can be sampled separately.

// A field of at most 32 x 16 blocks. All blocks share the running sums along rows of cells and
// along columns of blocks.
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

  // The factor from a point's weight to its pdf over solid angle, when sampling the whole field.
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
