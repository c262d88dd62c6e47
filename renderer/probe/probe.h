// SPDX-License-Identifier: Apache-2.0
// The light probe: one radiance function of direction, shared by light samples, escaping rays,
// mirrors, the camera and the irradiance.
#pragma once

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
  vec3 toMap(const vec3& d) const {
    if (isTilted_) [[unlikely]]
      return d * toWorld_;  // the transpose
    return d;
  }
  vec3 toWorld(const vec3& d) const {
    if (isTilted_) [[unlikely]]
      return toWorld_ * d;
    return d;
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
  struct Position {
    int column, row;
    float s, t;
    float sinTheta;
  };
  Position locate(const vec3& direction) const;
  vec3 direction(Position& position) const;  // sets position.sinTheta

  // Radiance at the corners of a cell: c10 at column + 1, c01 at row + 1.
  struct Corners {
    Rgb c00, c10, c01, c11;
  };
  Corners corners(int column, int row) const {
    const Rgb* top = &grid_[size_t(row) * (width_ + 1) + column];
    const Rgb* bottom = top + width_ + 1;
    return {top[0], top[1], bottom[0], bottom[1]};
  }
  // Fetches into the cache what corners() reads.
  void prefetch(int column, int row) const {
    const Rgb* top = &grid_[size_t(row) * (width_ + 1) + column];
    __builtin_prefetch(top);
    __builtin_prefetch(top + width_ + 1);
  }
  static Rgb interpolate(const Corners& c, float s, float t) {
    return (1 - t) * ((1 - s) * c.c00 + s * c.c10) + t * ((1 - s) * c.c01 + s * c.c11);
  }

  // Radiance arriving from `direction` (unit, pointing away from the scene).
  Rgb radiance(const vec3& direction) const {
    const Position p = locate(direction);
    return interpolate(corners(p.column, p.row), p.s, p.t);
  }

 private:
  int width_, height_;
  Rotation rotation_;
  MapTurn turn_;           // as the rotation
  std::vector<Rgb> grid_;  // (H + 2) rows of W + 1 corners; the last column repeats the first
};

inline Probe::Position Probe::locate(const vec3& direction) const {
  const vec3 d = turn_.toMap(direction);
  const float sinTheta = std::sqrt(d.x * d.x + d.z * d.z);
  float u = 0.5f + atan2Turns(d.x, -d.z) - turn_.uShift();
  u -= std::floor(u);
  const float v = 2 * atan2Turns(sinTheta, d.y);

  Position p;
  p.sinTheta = sinTheta;
  // Column 0's centre lies at u = 0.5 / W.
  float x = u * float(width_) - 0.5f;
  if (x < 0) x += float(width_);
  // Clamped on both sides, a NaN to 0: its direction must give NaN and not read outside the map.
  const auto cell = [](float at, int last) {
    return int(std::min(std::max(0.0f, at), float(last)));
  };
  p.column = cell(x, width_ - 1);
  p.s = x - float(p.column);
  const float y = v * float(height_) + 0.5f;  // corner rows 1..H at whole numbers
  p.row = cell(y, height_);
  p.t = y - float(p.row);
  if (p.row == 0)
    p.t = 2 * y - 1;  // from the pole at y = 1/2
  else if (p.row == height_)
    p.t *= 2;
  return p;
}

inline vec3 Probe::direction(Position& p) const {
  const float x = float(p.column) + p.s + 0.5f;
  float y = float(p.row) + p.t - 0.5f;
  if (p.row == 0)
    y = 0.5f * p.t;
  else if (p.row == height_)
    y = float(height_) - 0.5f + 0.5f * p.t;
  float sinPhi, cosPhi, cosTheta;
  sinCosTurns(x / float(width_) + turn_.uShift(), sinPhi, cosPhi);
  sinCosTurns(0.5f * y / float(height_), p.sinTheta, cosTheta);
  p.sinTheta = std::max(p.sinTheta, 0.0f);
  // u = 1/2 shows -Z: x = sin(2 pi (u - 1/2)) = -sin(2 pi u), z = -cos(2 pi (u - 1/2)).
  return turn_.toWorld({-p.sinTheta * sinPhi, cosTheta, p.sinTheta * cosPhi});
}

}  // namespace chromeball
