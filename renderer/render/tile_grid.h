// SPDX-License-Identifier: Apache-2.0
// The tiles in which an image is rendered.
#pragma once

#include <algorithm>
#include <cstddef>

#include "film/rows.h"

namespace chromeball {

struct TileGrid {
  static constexpr int kSize = 16;  // pixels

  int width, height;  // of the image

  int columns() const { return (width + kSize - 1) / kSize; }
  int rows() const { return (height + kSize - 1) / kSize; }
  size_t count() const { return size_t(columns()) * size_t(rows()); }

  PixelRect rectOf(size_t tile) const {
    const int left = int(tile % size_t(columns())) * kSize;
    const int top = int(tile / size_t(columns())) * kSize;
    return {left, top, std::min(kSize, width - left), std::min(kSize, height - top)};
  }

  // In scanline order.
  template <class Visit>
  void forPixels(size_t tile, const Visit& visit) const {
    const PixelRect rect = rectOf(tile);
    for (int y = rect.y; y < rect.y + rect.height; ++y)
      for (int x = rect.x; x < rect.x + rect.width; ++x) visit(x, y);
  }
};

}  // namespace chromeball
