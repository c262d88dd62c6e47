// SPDX-License-Identifier: Apache-2.0
// The light probe: one radiance function of direction, shared by light samples, escaping rays,
// mirrors, the camera and the irradiance.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "image/image.h"
#include "math/rotation.h"
#include "math/vec.h"

namespace chromeball {

// The turn of a lat-long map, applied when directions are looked up in it.

// A yaw shifts the map's u. A tilt is a matrix that is applied to the directions, and not to the
// map, which is never resampled; without one it costs a branch that is always predicted.
class MapTurn {
 public:
  explicit MapTurn(const Rotation& rotation)
      : isTilted_(rotation.isTilted()),
        uShift_(isTilted_ ? 0 : -rotation.yaw() / 360),
        toWorld_(glm::mat3_cast(rotation.quaternion())) {
    uShift_ -= std::floor(uShift_);
  }

  // The turned map's u minus the map's own, in turns, [0, 1).
  float uShift() const { return uShift_; }
  // Converts to and from the frame in which the map is shifted by uShift().
  template <class F>
  Lanes3<F> toMap(const Lanes3<F>& d) const {
    if (!isTilted_) [[likely]]
      return d;
    const auto along = [&](int axis) {  // the transpose
      const vec3& m = toWorld_[axis];
      return m.x * d.x + m.y * d.y + m.z * d.z;
    };
    return {along(0), along(1), along(2)};
  }
  vec3 toMap(const vec3& d) const { return vectorOf(toMap(lanesOf(d))); }
  vec3 toWorld(const vec3& d) const { return vectorOf(toWorld(lanesOf(d))); }
  template <class F>
  Lanes3<F> toWorld(const Lanes3<F>& d) const {
    if (!isTilted_) [[likely]]
      return d;
    const auto component = [&](int i) {
      return toWorld_[0][i] * d.x + toWorld_[1][i] * d.y + toWorld_[2][i] * d.z;
    };
    return {component(0), component(1), component(2)};
  }

 private:
  bool isTilted_;
  float uShift_;
  mat3 toWorld_;
};

// Bilinear interpolation of the texels of a lat-long image. It wraps at the seam, and at each pole
// it is the mean of the adjacent row, so it is continuous on the whole sphere.
//
// Cells have texel centres as corners. Corner column c is at u = (c + 1/2)/W. Corner row 0 is the
// north pole, rows 1 to H are the image's rows, row H + 1 is the south pole. So there are H + 1
// rows of W cells; the first and the last row of cells are half as high.
class Probe {
 public:
  // `latLong` has at least three channels and no invalid texel (edit.h). `rotation` turns the
  // environment. Throws InputError if a texel times `scale` is not finite, or `scale` is negative.
  explicit Probe(const Image& latLong, const Rotation& rotation = {}, const Rgb& scale = Rgb(1));

  int width() const { return width_; }
  int height() const { return height_; }
  int cellRows() const { return height_ + 1; }

  // The image times the scale, not rotated; and the rotation.
  Image latLong() const;
  const Rotation& rotation() const { return rotation_; }
  void turnTo(const Rotation& rotation) {
    rotation_ = rotation;
    turn_ = MapTurn(rotation);
  }

  // A position in the map: the cell, (s, t) in [0, 1]^2 inside it, and the sine of the polar angle.
  template <class F>
  struct PositionOf {
    IntOf<F> column, row;
    F s, t;
    F sinTheta;
  };
  using Position = PositionOf<float>;
  template <class F>
  PositionOf<F> locate(const Lanes3<F>& direction) const;
  template <class F>
  Lanes3<F> directionAt(PositionOf<F>& position) const;  // sets position.sinTheta
  Position locate(const vec3& d) const { return locate(lanesOf(d)); }
  vec3 direction(Position& position) const { return vectorOf(directionAt(position)); }

  // Radiance at the corners of a cell: c10 at column + 1, c01 at row + 1.
  struct Corners {
    Rgb c00, c10, c01, c11;
  };
  Corners corners(int column, int row) const {
    const Rgb* top = &grid_[size_t(row) * (width_ + 1) + column];
    const Rgb* bottom = top + width_ + 1;
    return {top[0], top[1], bottom[0], bottom[1]};
  }
  // The same for each lane.
  template <class F>
  struct CornersOf {
    Lanes3<F> c00, c10, c01, c11;
  };
  template <class F>
  CornersOf<F> cornersOf(const PositionOf<F>& p) const;
  // Fetches into the cache what corners() reads.
  void prefetch(int column, int row) const {
    const Rgb* top = &grid_[size_t(row) * (width_ + 1) + column];
    __builtin_prefetch(top);
    __builtin_prefetch(top + width_ + 1);
  }
  template <class F>
  static Lanes3<F> interpolate(const CornersOf<F>& c, F s, F t) {
    const auto mix = [&](F c00, F c10, F c01, F c11) {
      return (1 - t) * ((1 - s) * c00 + s * c10) + t * ((1 - s) * c01 + s * c11);
    };
    return {mix(c.c00.x, c.c10.x, c.c01.x, c.c11.x), mix(c.c00.y, c.c10.y, c.c01.y, c.c11.y),
            mix(c.c00.z, c.c10.z, c.c01.z, c.c11.z)};
  }

  // Radiance arriving from `direction` (unit, pointing away from the scene).
  Rgb radiance(const vec3& direction) const { return vectorOf(radiance(locate(direction))); }
  template <class F>
  Lanes3<F> radiance(const PositionOf<F>& p) const {
    return interpolate(cornersOf(p), p.s, p.t);
  }

 private:
  int width_, height_;
  Rotation rotation_;
  MapTurn turn_;  // as the rotation
  // (H + 2) rows of W + 1 corners, the last column repeating the first; and one more, for reads of
  // eight numbers at once.
  std::vector<Rgb> grid_;
};

template <class F>
Probe::PositionOf<F> Probe::locate(const Lanes3<F>& direction) const {
  const Lanes3<F> d = turn_.toMap(direction);
  const F sinTheta = LanesOf<F>::squareRoot(d.x * d.x + d.z * d.z);
  F u = 0.5f + atan2Turns(d.x, -d.z) - turn_.uShift();
  u -= LanesOf<F>::floor(u);
  const F v = 2 * atan2Turns(sinTheta, d.y);

  PositionOf<F> p;
  p.sinTheta = sinTheta;
  // Column 0's centre lies at u = 0.5 / W.
  F x = u * float(width_) - 0.5f;
  x = x < 0 ? x + float(width_) : x;
  // Clamped on both sides, a NaN to 0: its direction must give NaN and not read outside the map.
  const auto cell = [](F at, int last) {
    return LanesOf<F>::toInt(
        smaller(larger(LanesOf<F>::splat(0), at), LanesOf<F>::splat(float(last))));
  };
  p.column = cell(x, width_ - 1);
  p.s = x - LanesOf<F>::toFloat(p.column);
  const F y = v * float(height_) + 0.5f;  // corner rows 1..H at whole numbers
  p.row = cell(y, height_);
  p.t = y - LanesOf<F>::toFloat(p.row);
  // From the pole at y = 1/2 in the first row.
  p.t = p.row == 0 ? 2 * y - 1 : p.row == height_ ? 2 * p.t : p.t;
  return p;
}

template <class F>
Lanes3<F> Probe::directionAt(PositionOf<F>& p) const {
  const F x = LanesOf<F>::toFloat(p.column) + p.s + 0.5f;
  F y = LanesOf<F>::toFloat(p.row) + p.t - 0.5f;
  y = p.row == 0 ? 0.5f * p.t : p.row == height_ ? float(height_) - 0.5f + 0.5f * p.t : y;
  F sinPhi, cosPhi, cosTheta;
  sinCosTurns(x / float(width_) + turn_.uShift(), sinPhi, cosPhi);
  sinCosTurns(0.5f * y / float(height_), p.sinTheta, cosTheta);
  p.sinTheta = larger(p.sinTheta, LanesOf<F>::splat(0));
  // u = 1/2 shows -Z: x = sin(2 pi (u - 1/2)) = -sin(2 pi u), z = -cos(2 pi (u - 1/2)).
  return turn_.toWorld(Lanes3<F>{-p.sinTheta * sinPhi, cosTheta, p.sinTheta * cosPhi});
}

template <class F>
Probe::CornersOf<F> Probe::cornersOf(const PositionOf<F>& p) const {
  if constexpr (LanesOf<F>::kCount == 1) {
    const Corners c = corners(p.column, p.row);
    return {lanesOf(c.c00), lanesOf(c.c10), lanesOf(c.c01), lanesOf(c.c11)};
  } else {
    // Two corners of three numbers each, and two numbers more. The bits of an index are those of a
    // number without sign.
    const IntOf<F> index = p.row * (width_ + 1) + p.column;
    const auto edge = [&](size_t offset) {
      std::array<const float*, LanesOf<F>::kCount> first;
      for (size_t k = 0; k < first.size(); ++k)
        first[k] = &grid_[size_t(uint32_t(index[k])) + offset].x;
      return LanesOf<F>::columns(first);
    };
    const auto top = edge(0), bottom = edge(size_t(width_) + 1);
    return {{top[0], top[1], top[2]},
            {top[3], top[4], top[5]},
            {bottom[0], bottom[1], bottom[2]},
            {bottom[3], bottom[4], bottom[5]}};
  }
}

}  // namespace chromeball
