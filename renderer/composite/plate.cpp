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

std::vector<size_t> pixelsIn(const vec4& part, int width, int height) {
  std::vector<size_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const vec2 middle((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height));
      if (middle.x >= part.x && middle.x <= part.z && middle.y >= part.y && middle.y <= part.w)
        pixels.push_back(size_t(y) * size_t(width) + size_t(x));
    }
  return pixels;
}

namespace {

std::vector<double> luminancesOf(const Image& plate, const std::vector<size_t>& pixels) {
  std::vector<double> luminances;
  for (const size_t i : pixels) luminances.push_back(luminance(glm::dvec3(plate.rgb(i))));
  return luminances;
}

}  // namespace

float reflectanceInPhotograph(const Image& plate, const std::vector<size_t>& pixels,
                              const vec2& range) {
  return std::clamp(float(quantile(luminancesOf(plate, pixels), 0.5)), range.x, range.y);
}

PlateScale scaleByPlate(const Image& plate, const std::vector<size_t>& pixels,
                        const Rgb& irradiance, const Rgb& reflectance) {
  constexpr double kLow = 0.16, kHigh = 0.84;  // one standard deviation of a normal distribution
  PlateScale result{.reflectance = reflectance, .pixels = pixels.size()};
  for (int c = 0; c < 3; ++c) {
    std::vector<double> radiance;
    for (const size_t i : pixels) radiance.push_back(double(plate.rgb(i)[c]));
    result.scale[c] =
        float(kPiD * quantile(radiance, 0.5) / (double(reflectance[c]) * double(irradiance[c])));
  }
  const std::vector<double> luminances = luminancesOf(plate, pixels);
  const double spread = quantile(luminances, kHigh) - quantile(luminances, kLow);
  result.scatter = 0.5 * spread / quantile(luminances, 0.5);
  return result;
}

}  // namespace chromeball
