// SPDX-License-Identifier: Apache-2.0
#include "composite/plate.h"

#include <cmath>

#include "base/error.h"
#include "image/io/read_image.h"
#include "math/cdf.h"
#include "trace/accel.h"

namespace chromeball {

Image readPlate(const std::string& path, Messages* messages, Messages* decoding) {
  ImageFile file = readImageFile(path);
  if (messages) messages->insert(messages->end(), file.messages.begin(), file.messages.end());
  if (decoding && file.integers) addNote(*decoding, "{}: {}", path, decodingInWords(file));
  Image plate = colorOf(std::move(file), path);
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

std::vector<size_t> pixelsThatShow(int ground, const Bounds& part, const Scene& localScene,
                                   const Camera& camera, int width, int height) {
  const Accel accel(localScene);
  const CameraRays rays(camera, float(width) / float(height));
  std::vector<size_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Ray ray;
      rays.ray((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height), ray.origin,
               ray.direction);
      Hit hit;
      if (!accel.intersect(ray, 0, hit) || localScene.instances[hit.instance].node != ground)
        continue;
      const vec3 point = ray.origin + hit.distance * ray.direction;
      if (point.x >= part.min.x && point.x <= part.max.x && point.z >= part.min.z &&
          point.z <= part.max.z)
        pixels.push_back(size_t(y) * size_t(width) + size_t(x));
    }
  return pixels;
}

PlateScale scaleByPlate(const Image& plate, const std::vector<size_t>& pixels,
                        const Rgb& irradiance, const Rgb& reflectance) {
  constexpr double kLow = 0.16, kHigh = 0.84;  // one standard deviation of a normal distribution
  PlateScale result{.pixels = pixels.size()};
  const auto valuesOf = [&](const auto& value) {
    std::vector<double> values;
    for (const size_t i : pixels)
      values.push_back(
          value(plate.rgb(int(i % size_t(plate.width)), int(i / size_t(plate.width)))));
    return values;
  };
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> radiance =
        valuesOf([c](const Rgb& pixel) { return double(pixel[c]); });
    result.scale[c] =
        float(kPiD * quantile(radiance, 0.5) / (double(reflectance[c]) * double(irradiance[c])));
  }
  const std::vector<double> luminances =
      valuesOf([](const Rgb& p) { return luminance(glm::dvec3(p)); });
  const double spread = quantile(luminances, kHigh) - quantile(luminances, kLow);
  result.scatter = 0.5 * spread / quantile(luminances, 0.5);
  return result;
}

}  // namespace chromeball
