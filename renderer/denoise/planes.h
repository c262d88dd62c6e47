// SPDX-License-Identifier: Apache-2.0
// Images as separate planes with a margin, so that windows around any pixel can be read.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "image/image.h"

namespace chromeball {

// One channel. Pixels outside the image, at most kMargin away, can be read. Copies share the
// pixels. A new plane is not initialized.
class Plane {
 public:
  static constexpr int kMargin = 56;

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
  parallelFor(0, height, [&](int y) {
    float* row = plane.row(y);
    for (int x = 0; x < width; ++x) row[x] = value(x, y);
  });
  plane.extend();
  return plane;
}

Plane planeOf(const Image& image, int channel);

// The mean over the window of 2 reach + 1 columns and rows around each pixel.
Plane boxMean(const Plane& plane, int reach);

}  // namespace chromeball
