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
    const Probe::Position p{column, row, 0, 0, 0};
    const Weights<float> w = weights(probe_->cornersOf(p), row);
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
    return pointOf(at(lanesOf(direction), p));
  }

  // A point of a cell with integral > 0, with pdf proportional to w, from two numbers in [0, 1).
  Point sample(int column, int row, float u, float v) const {
    return pointOf(sample<float>(column, row, u, v));
  }

  // The same for one direction, or one point, in each lane.
  template <class F>
  struct PointOf {
    Lanes3<F> direction, radiance;
    F weight;
  };
  template <class F>
  PointOf<F> at(const Lanes3<F>& direction, const Probe::PositionOf<F>& p) const {
    const Probe::CornersOf<F> corners = probe_->cornersOf(p);
    return at(direction, p, corners, weights(corners, p.row));
  }
  template <class F>
  PointOf<F> sample(IntOf<F> column, IntOf<F> row, F u, F v) const {
    Probe::PositionOf<F> p{column, row, {}, {}, {}};
    const Probe::CornersOf<F> corners = probe_->cornersOf(p);
    const Weights<F> w = weights(corners, row);
    p.t = sampleLinear(v, w.w00 + w.w10, w.w01 + w.w11);
    p.s = sampleLinear(u, (1 - p.t) * w.w00 + p.t * w.w01, (1 - p.t) * w.w10 + p.t * w.w11);
    const Lanes3<F> direction = probe_->directionAt(p);
    return at(direction, p, corners, w);
  }

  // Solid angle = jacobian x sin(theta) x area in cells.
  double jacobian() const { return 2 * kPiD * kPiD / (double(probe_->width()) * probe_->height()); }

 private:
  template <class F>
  struct Weights {
    F w00, w10, w01, w11;
    F at(F s, F t) const {
      return (1 - t) * ((1 - s) * w00 + s * w10) + t * ((1 - s) * w01 + s * w11);
    }
  };
  template <class F>
  Weights<F> weights(const Probe::CornersOf<F>& c, IntOf<F> row) const {
    const F top = LanesOf<F>::gather(rowSine_.data(), row),
            bottom = LanesOf<F>::gather(rowSine_.data(), row + 1);
    const auto weight = [&](const Lanes3<F>& radiance) {
      return larger(luminance(radiance) - offset_, LanesOf<F>::splat(0));
    };
    return {weight(c.c00) * top, weight(c.c10) * top, weight(c.c01) * bottom,
            weight(c.c11) * bottom};
  }

  template <class F>
  static PointOf<F> at(const Lanes3<F>& direction, const Probe::PositionOf<F>& p,
                       const Probe::CornersOf<F>& corners, const Weights<F>& w) {
    return {direction, Probe::interpolate(corners, p.s, p.t),
            w.at(p.s, p.t) / larger(p.sinTheta, LanesOf<F>::splat(1e-9f))};
  }

  static Point pointOf(const PointOf<float>& p) {
    return {vectorOf(p.direction), vectorOf(p.radiance), p.weight};
  }

  // A number in [0, 1) with pdf proportional to a (1 - x) + b x; u if both are 0. Divides by the
  // greater of a and b because the squares of numbers outside 1e-19..1e19 exceed the range of a
  // float.
  template <class F>
  static F sampleLinear(F u, F a, F b) {
    const F greater = larger(a, b), from = a / greater, to = b / greater;
    const F root = LanesOf<F>::squareRoot(
        larger(from * from + u * (to * to - from * from), LanesOf<F>::splat(0)));
    const F x = smaller(
        u * (from + to) / larger(from + root, LanesOf<F>::splat(std::numeric_limits<float>::min())),
        LanesOf<F>::splat(0x1.fffffep-1f));
    return greater > 0 ? x : u;
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
