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
  std::fill_n(row(-kMargin) - kMargin, size_t(stride_) * size_t(height_ + 2 * kMargin), 0.0f);
}

Plane planeOf(const Image& image, int channel) {
  return makePlane(image.width, image.height,
                   [&](int x, int y) { return image.at(x, y)[channel]; });
}

Plane boxMean(const Plane& plane, int reach) {
  const int width = plane.width(), height = plane.height();
  const float scale = 1 / float(2 * reach + 1);
  // A row of sums, by sums of whole rows or parts of them, which are vectors.
  const auto means = [&](const auto& summand) {
    Plane result(width, height);
    forIndices(size_t(height), size_t(width) * size_t(reach + 1), [&](size_t i) {
      const int y = int(i);
      float* sums = result.row(y);
      std::fill_n(sums, width, 0.0f);
      for (int k = -reach; k <= reach; ++k) {
        const float* from = summand(y, k);
        for (int x = 0; x < width; ++x) sums[x] += from[x];
      }
      for (int x = 0; x < width; ++x) sums[x] *= scale;
    });
    result.extend();
    return result;
  };
  const Plane rows = means([&](int y, int k) { return plane.row(y) + k; });
  return means([&](int y, int k) { return rows.row(y + k); });
}

}  // namespace chromeball
