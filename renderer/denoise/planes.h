// SPDX-License-Identifier: Apache-2.0
// Images as separate planes with a margin, so that windows around any pixel can be read.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

#include "base/parallel.h"
#include "image/image.h"

namespace chromeball {

// One channel. Pixels outside the image, at most kMargin away, can be read. Copies share the
// pixels. A new plane is not initialized.
class Plane {
 public:
  static constexpr int kMargin = 32;

  Plane() = default;
  Plane(int width, int height)
      : width_(width),
        height_(height),
        stride_(width + 2 * kMargin),
        data_(std::make_shared_for_overwrite<float[]>(size_t(stride_) *
                                                      size_t(height + 2 * kMargin))) {}

  int width() const { return width_; }
  int height() const { return height_; }
  float* row(int y) { return data_.get() + offset(y); }
  const float* row(int y) const { return data_.get() + offset(y); }
  float at(int x, int y) const { return row(y)[x]; }

  // Copies the pixels at the image's edge outwards.
  void extend();
  void clear();

 private:
  ptrdiff_t offset(int y) const { return ptrdiff_t(y + kMargin) * stride_ + kMargin; }

  int width_ = 0, height_ = 0, stride_ = 0;
  std::shared_ptr<float[]> data_;
};

using RgbPlanes = std::array<Plane, 3>;

// The plane of value(x, y), on all threads.
template <class Value>
Plane makePlane(int width, int height, const Value& value) {
  Plane plane(width, height);
  forIndices(size_t(height), size_t(width), [&](size_t i) {
    const int y = int(i);
    float* row = plane.row(y);
    for (int x = 0; x < width; ++x) row[x] = value(x, y);
  });
  plane.extend();
  return plane;
}

// The same, of the size of another plane.
template <class Value>
Plane makePlaneLike(const Plane& like, const Value& value) {
  return makePlane(like.width(), like.height(), value);
}

Plane planeOf(const Image& image, int channel);

// The mean over the window of 2 reach + 1 columns and rows around each pixel.
Plane boxMean(const Plane& plane, int reach);

// Eight floats of consecutive pixels, processed together.

constexpr int kLanes = 8;
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));

inline Float8 load8(const float* from) {
  Float8 v;
  std::memcpy(&v, from, sizeof(v));
  return v;
}
inline void store8(float* to, Float8 v) { std::memcpy(to, &v, sizeof(v)); }
inline Float8 splat8(float x) { return Float8{} + x; }
inline Float8 max8(Float8 a, Float8 b) { return a > b ? a : b; }
inline Float8 min8(Float8 a, Float8 b) { return a < b ? a : b; }

inline bool anyAbove(Float8 v, float limit) {
  const Int8 above = v > limit;
  int any = 0;
  for (int k = 0; k < kLanes; ++k) any |= above[k];
  return any != 0;
}

// exp(-x) for x >= 0, relative error below 1e-5; 0 beyond 40.
inline Float8 expOfMinus(Float8 x) {
  const Float8 t = min8(x, splat8(60)) * -1.44269504f;
  const Int8 whole = __builtin_convertvector(t - 0.5f, Int8);  // rounds towards zero: nearest
  const Float8 f = (t - __builtin_convertvector(whole, Float8)) * 0.693147181f;
  const Float8 series =
      1 + f * (1 + f * (0.5f + f * (1 / 6.0f + f * (1 / 24.0f + f * (1 / 120.0f)))));
  const Int8 exponent = (whole + 127) << 23;
  Float8 power;
  std::memcpy(&power, &exponent, sizeof(power));
  return x > 40.0f ? Float8{} : power * series;
}

}  // namespace chromeball
