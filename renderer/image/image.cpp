// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <algorithm>

#include "base/memory.h"

namespace chromeball {

Image::Image(int w, int h, int c)
    : width(w), height(h), channels(c), texels(longArray<float>(size_t(w) * h * c)) {}

namespace {

// Resampling from `from` texels to `to`: pixel i covers [i, i + 1) * from / to. Calls
// add(texel, weight) for each covered texel; the weights sum to 1.
template <class Add>
void forCovered(int i, int to, int from, const Add& add) {
  const double begin = double(i) * from / to, end = double(i + 1) * from / to;
  for (int texel = int(begin); texel < from && texel < end; ++texel)
    add(texel, (std::min(end, texel + 1.0) - std::max(begin, double(texel))) / (end - begin));
}

}  // namespace

Image resampled(const Image& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  const int channels = image.channels;
  Image narrow(width, image.height, channels), scaled(width, height, channels);
  std::vector<double> sum(static_cast<size_t>(channels));
  const auto set = [&](float* to) {
    std::ranges::copy(sum, to);
    std::ranges::fill(sum, 0.0);
  };
  const auto add = [&](const float* from, double fraction) {
    for (int c = 0; c < channels; ++c) sum[size_t(c)] += fraction * double(from[c]);
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      forCovered(x, width, image.width, [&](int i, double part) { add(image.at(i, y), part); });
      set(narrow.at(x, y));
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      forCovered(y, height, image.height, [&](int i, double part) { add(narrow.at(x, i), part); });
      set(scaled.at(x, y));
    }
  return scaled;
}

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
