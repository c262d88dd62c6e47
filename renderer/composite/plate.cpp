// SPDX-License-Identifier: Apache-2.0
#include "composite/plate.h"

#include <cmath>

#include "base/error.h"
#include "image/io/read_image.h"

namespace chromeball {
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

Image readPlate(const std::string& path) {
  Image plate = readImage(path);
  size_t invalid = 0;
  int x = 0, y = 0;
  for (int row = plate.height - 1; row >= 0; --row)
    for (int column = plate.width - 1; column >= 0; --column)
      if (!isFinite(plate.rgb(column, row))) ++invalid, x = column, y = row;
  if (invalid)
    throwInput("{}: {} pixels of the plate are NaN or infinite, the first at ({}, {}); repair them",
               path, invalid, x, y);
  return plate;
}

Image scaledPlate(const Image& image, int width, int height, const std::string& name) {
  if (image.width == width && image.height == height) return image;
  const double across = double(image.width) * height / image.height - width;
  const double down = double(image.height) * width / image.width - height;
  if (std::min(std::abs(across), std::abs(down)) > 0.5)
    throwInput(
        "{}: the plate has {}x{} pixels, but the image size is {}x{}; leave out the size, or give "
        "one with the plate's aspect ratio",
        name, image.width, image.height, width, height);

  Image narrow(width, image.height, 3), scaled(width, height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0);
      forCovered(x, width, image.width,
                 [&](int i, double fraction) { sum += fraction * glm::dvec3(image.rgb(i, y)); });
      narrow.setRgb(x, y, Rgb(sum));
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec3 sum(0);
      forCovered(y, height, image.height,
                 [&](int i, double fraction) { sum += fraction * glm::dvec3(narrow.rgb(x, i)); });
      scaled.setRgb(x, y, Rgb(sum));
    }
  return scaled;
}

}  // namespace chromeball
