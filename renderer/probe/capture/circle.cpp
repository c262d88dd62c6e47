// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/circle.h"

namespace chromeball {

// The mean over strips of the chord that is inside, each weighted by its length.
double shareInside(const Circle& circle, int width, int height) {
  constexpr int kStrips = 400;
  double inside = 0, all = 0;
  for (int i = 0; i < kStrips; ++i) {
    const double down = 2 * (i + 0.5) / kStrips - 1;  // in radii
    const double half = std::sqrt(1 - down * down) * circle.radius;
    const double y = circle.centre.y + down * circle.radius;
    all += 2 * half;
    if (y < 0 || y > height) continue;
    const double left = std::max(circle.centre.x - half, 0.0);
    const double right = std::min(circle.centre.x + half, double(width));
    inside += std::max(right - left, 0.0);
  }
  return inside / all;
}

}  // namespace chromeball
