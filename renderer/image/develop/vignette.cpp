// SPDX-License-Identifier: Apache-2.0
#include "image/develop/vignette.h"

#include <algorithm>

#include "base/parallel.h"

namespace chromeball {
namespace {

struct Between {
  int first, second;
  float t;
};

// The position of pixel i of `count` among n texels.
Between position(int i, int count, int n) {
  const double u = std::clamp((i + 0.5) * n / count - 0.5, 0.0, double(n - 1));
  const int first = int(u);
  return {first, std::min(first + 1, n - 1), float(u - first)};
}

// The first three channels, or one for all.
Rgb texel(const Image& image, int x, int y) {
  return image.channels >= 3 ? image.rgb(x, y) : Rgb(*image.at(x, y));
}

}  // namespace

void vignette(Image& image, double strength, const ViewFrame& frame) {
  const double size = frame.pixelSize();
  forRows(image.width, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const double across = size * (frame.x + x + 0.5 - 0.5 * frame.width);
      const double up = size * (frame.y + y + 0.5 - 0.5 * frame.height);
      const double cos2 = 1 / (1 + across * across + up * up);
      image.setRgb(x, y, image.rgb(x, y) * float(1 - strength * (1 - cos2 * cos2)));
    }
  });
}

void multiplyFalloff(Image& image, const Image& falloff, const ViewFrame& frame) {
  forRows(image.width, image.height, [&](int y) {
    const Between v = position(frame.y + y, frame.height, falloff.height);
    for (int x = 0; x < image.width; ++x) {
      const Between u = position(frame.x + x, frame.width, falloff.width);
      const auto row = [&](int j) {
        return glm::mix(texel(falloff, u.first, j), texel(falloff, u.second, j), u.t);
      };
      image.setRgb(x, y, image.rgb(x, y) * glm::mix(row(v.first), row(v.second), v.t));
    }
  });
}

}  // namespace chromeball
