// SPDX-License-Identifier: Apache-2.0
// Rows of an image, and its division into bands of some rows, which files store one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace chromeball {

struct Rows {
  int begin = 0, count = 0;

  // The items for these rows, of a list with `perRow` items for each row of the image.
  template <class T>
  std::span<T> of(std::vector<T>& items, size_t perRow) const {
    return std::span(items).subspan(size_t(begin) * perRow, size_t(count) * perRow);
  }
};

// Pixels (x, y) to (x + width - 1, y + height - 1).
struct PixelRect {
  int x, y, width, height;

  // Copies `perPixel` items for each of these pixels, in an image that is `across` pixels wide.
  template <class T>
  void copy(const std::vector<T>& from, std::vector<T>& to, int across, size_t perPixel = 1) const {
    for (int row = y; row < y + height; ++row) {
      const size_t first = (size_t(row) * size_t(across) + size_t(x)) * perPixel;
      std::copy_n(from.begin() + ptrdiff_t(first), size_t(width) * perPixel,
                  to.begin() + ptrdiff_t(first));
    }
  }

  // Only the items of these pixels.
  template <class T>
  std::vector<T> of(const std::vector<T>& items, int across, size_t perPixel = 1) const {
    std::vector<T> part;
    if (items.empty()) return part;
    part.reserve(size_t(width) * size_t(height) * perPixel);
    for (int row = y; row < y + height; ++row) {
      const auto first =
          items.begin() + ptrdiff_t((size_t(row) * size_t(across) + size_t(x)) * perPixel);
      part.insert(part.end(), first, first + ptrdiff_t(size_t(width) * perPixel));
    }
    return part;
  }
};

// Each band has some megabytes of sums.
struct Bands {
  int width, height;

  size_t count() const { return (size_t(height) + rowsOfEach() - 1) / rowsOfEach(); }
  Rows rows(size_t band) const {
    const int begin = int(band * rowsOfEach());
    return {begin, std::min(int(rowsOfEach()), height - begin)};
  }

 private:
  static constexpr int kPixels = 16384;
  size_t rowsOfEach() const { return size_t(std::max(1, kPixels / width)); }
};

// The pixels of a square window of an image.

// Calls visit(index, dx, dy) for the pixels at most `reach` columns and rows from (x, y), itself
// included, in reading order. `index`: the pixel's index in the image.
template <class Visit>
void forWindow(int width, int height, int x, int y, int reach, const Visit& visit) {
  for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
    for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
      visit(size_t(v) * size_t(width) + size_t(u), u - x, v - y);
}

// The tiles in which an image is rendered.

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

  // Visits pixels in scanline order.
  template <class Visit>
  void forPixels(size_t tile, const Visit& visit) const {
    const PixelRect rect = rectOf(tile);
    for (int y = rect.y; y < rect.y + rect.height; ++y)
      for (int x = rect.x; x < rect.x + rect.width; ++x) visit(x, y);
  }
};

}  // namespace chromeball
