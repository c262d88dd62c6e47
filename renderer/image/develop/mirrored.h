// SPDX-License-Identifier: Apache-2.0
// Images beyond their borders: mirrored at the edge of the outermost pixel, again and again.
#pragma once

#include <cstdint>

namespace chromeball {

// The pixel of [0, n) that mirrors show at `i`: ... 1 0 | 0 1 ... n-1 | n-1 n-2 ... Of period 2n.
// A symmetric filter of sum 1 keeps the sum of an image that continues like this.
inline int mirrored(int64_t i, int n) {
  if (i >= 0 && i < n) return int(i);
  const int64_t period = 2 * int64_t(n);
  i %= period;
  if (i < 0) i += period;
  return int(i < n ? i : period - 1 - i);
}

}  // namespace chromeball
