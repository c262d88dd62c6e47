// SPDX-License-Identifier: Apache-2.0
// The pixels of a square window of an image.
#pragma once

#include <algorithm>
#include <cstddef>

namespace chromeball {

// Calls visit(index, dx, dy) for the pixels at most `reach` columns and rows from (x, y), itself
// included, in reading order. `index`: of the pixel in the image.
template <class Visit>
void forWindow(int width, int height, int x, int y, int reach, const Visit& visit) {
  for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
    for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
      visit(size_t(v) * size_t(width) + size_t(u), u - x, v - y);
}

}  // namespace chromeball
