// SPDX-License-Identifier: Apache-2.0
#include "composite/plate.h"

#include <cmath>

#include "base/error.h"
#include "image/io/read_image.h"
#include "image/resample.h"

namespace chromeball {
Image readPlate(const std::string& path, Messages* messages) {
  Image plate = readImage(path, IntegerTexels::Srgb, messages);
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
  return resampled(image, width, height);
}

}  // namespace chromeball
