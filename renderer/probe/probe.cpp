// SPDX-License-Identifier: Apache-2.0
#include "probe/probe.h"

#include <atomic>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"

namespace chromeball {
namespace {

std::string text(const Rgb& scale) {
  return scale.x == scale.y && scale.y == scale.z
             ? fmt::format("{}", scale.x)
             : fmt::format("{},{},{}", scale.x, scale.y, scale.z);
}

}  // namespace

Probe::Probe(const Image& latLong, const Rotation& rotation, const Rgb& scale)
    : width_(latLong.width),
      height_(latLong.height),
      rotation_(rotation),
      turn_(rotation),
      grid_(longArray<Rgb>(size_t(width_ + 1) * (height_ + 2) + 1)) {
  if (!isFinite(scale) || std::min({scale.x, scale.y, scale.z}) < 0)
    throwInput("probe: the scale {} should be finite and not negative", text(scale));

  const auto corner = [&](int x, int cornerRow) -> Rgb& {
    return grid_[size_t(cornerRow) * (width_ + 1) + x];
  };
  std::atomic<bool> isValid = true;
  forRanges(size_t(height_), size_t(width_), [&](size_t begin, size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < width_; ++x) {
        corner(x, y + 1) = latLong.rgb(x, y) * scale;
        if (!isFinite(corner(x, y + 1))) isValid = false;
      }
  });
  for (int i = 0; !isValid && i < width_ * height_; ++i)
    if (const int x = i % width_, y = i / width_; !isFinite(corner(x, y + 1)))
      throwInput("probe: texel ({}, {}) times the scale {} exceeds the range of a float", x, y,
                 text(scale));
  const auto rowMean = [&](int cornerRow) {
    glm::dvec3 sum(0);
    for (int x = 0; x < width_; ++x) sum += glm::dvec3(corner(x, cornerRow));
    return Rgb(sum / double(width_));
  };
  const Rgb north = rowMean(1), south = rowMean(height_);
  for (int x = 0; x < width_; ++x) {
    corner(x, 0) = north;
    corner(x, height_ + 1) = south;
  }
  for (int y = 0; y < height_ + 2; ++y) corner(width_, y) = corner(0, y);
}

Image Probe::latLong() const {
  Image image(width_, height_, 3);
  forRows(width_, height_, [&](int y) {
    for (int x = 0; x < width_; ++x) image.setRgb(x, y, corners(x, y + 1).c00);
  });
  return image;
}

}  // namespace chromeball
