// SPDX-License-Identifier: Apache-2.0
#include "denoise/planes.h"

namespace chromeball {

void Plane::extend() {
  for (int y = 0; y < height_; ++y) {
    float* to = row(y);
    std::fill(to - kMargin, to, to[0]);
    std::fill(to + width_, to + width_ + kMargin, to[width_ - 1]);
  }
  const auto copyRow = [&](int from, int to) {
    std::copy_n(row(from) - kMargin, stride_, row(to) - kMargin);
  };
  for (int i = 1; i <= kMargin; ++i) copyRow(0, -i), copyRow(height_ - 1, height_ - 1 + i);
}

void Plane::clear() {
  parallelFor(-kMargin, height_ + kMargin,
              [&](int y) { std::fill_n(row(y) - kMargin, stride_, 0.0f); });
}

Plane planeOf(const Image& image, int channel) {
  return makePlane(image.width, image.height,
                   [&](int x, int y) { return image.at(x, y)[channel]; });
}

Plane boxMean(const Plane& plane, int reach) {
  const float scale = 1 / float(2 * reach + 1);
  const Plane rows = makePlaneLike(plane, [&](int x, int y) {
    float sum = 0;
    for (int i = -reach; i <= reach; ++i) sum += plane.at(x + i, y);
    return sum * scale;
  });
  return makePlaneLike(plane, [&](int x, int y) {
    float sum = 0;
    for (int i = -reach; i <= reach; ++i) sum += rows.at(x, y + i);
    return sum * scale;
  });
}

}  // namespace chromeball
