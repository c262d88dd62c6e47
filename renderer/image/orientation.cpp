// SPDX-License-Identifier: Apache-2.0
#include "image/orientation.h"

#include <algorithm>

namespace chromeball {

Image oriented(Image stored, int orientation) {
  if (orientation < 2 || orientation > 8) return stored;
  // The row and the column 0 of the file are these sides of the picture (TIFF 6.0, Orientation).
  const bool swapsSides = orientation >= 5;  // row 0 is the left or the right side
  const bool fromRight =
      orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool fromBottom =
      orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  Image seen(swapsSides ? stored.height : stored.width, swapsSides ? stored.width : stored.height,
             stored.channels);
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x) {
      const int fromLeft = fromRight ? seen.width - 1 - x : x;
      const int fromTop = fromBottom ? seen.height - 1 - y : y;
      const float* texel = swapsSides ? stored.at(fromTop, fromLeft) : stored.at(fromLeft, fromTop);
      std::copy_n(texel, stored.channels, seen.at(x, y));
    }
  return seen;
}

}  // namespace chromeball
