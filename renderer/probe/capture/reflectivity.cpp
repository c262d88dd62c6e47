// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/reflectivity.h"

#include <array>
#include <charconv>

#include "base/error.h"

namespace chromeball {

PixelRectangle parseRectangle(std::string_view text, std::string_view location) {
  std::array<int, 4> numbers{};
  const char *at = text.data(), *const end = at + text.size();
  bool valid = true;
  for (size_t i = 0; i < numbers.size() && valid; ++i) {
    if (i > 0) valid = at != end && *at++ == ',';
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    valid = valid && error == std::errc();
    at = next;
  }
  if (!valid || at != end || numbers[2] < 1 || numbers[3] < 1)
    throwInput("{}: `{}` should be X,Y,WIDTH,HEIGHT in whole pixels", location, text);
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

PatchMean patchMean(const Image& image, const PixelRectangle& r, double saturation,
                    std::string_view location) {
  if (r.x < 0 || r.y < 0 || r.width > image.width - r.x || r.height > image.height - r.y)
    throwInput("{}: {},{},{},{} reaches outside the picture of {} x {} pixels", location, r.x, r.y,
               r.width, r.height, image.width, image.height);
  if (r.width == 1 && r.height == 1)
    throwInput("{}: one pixel has no standard error; give a rectangle of several", location);
  glm::dvec3 sum(0), squares(0);
  const glm::dvec3 first(image.rgb(r.x, r.y));  // the others differ little from it
  for (int y = r.y; y < r.y + r.height; ++y)
    for (int x = r.x; x < r.x + r.width; ++x) {
      const Rgb pixel = image.rgb(x, y);
      for (int c = 0; c < 3; ++c) {
        if (!std::isfinite(pixel[c]) || pixel[c] < 0)
          throwInput("{}: the pixel at {}, {} is {}, which is no radiance", location, x, y,
                     pixel[c]);
        if (double(pixel[c]) >= saturation)
          throwInput("{}: the pixel at {}, {} is saturated: {}, which is not below {}", location, x,
                     y, pixel[c], saturation);
      }
      const glm::dvec3 difference = glm::dvec3(pixel) - first;
      sum += difference;
      squares += difference * difference;
    }
  const double n = double(r.width) * r.height;
  const glm::dvec3 variance = glm::max(squares - sum * sum / n, 0.0) / (n - 1);
  return {first + sum / n, glm::sqrt(variance / n), size_t(n)};
}

Reflectivity reflectivity(const PatchMean& numerator, const PatchMean& denominator,
                          const glm::dvec3& standard, std::string_view location) {
  for (int c = 0; c < 3; ++c)
    if (!(denominator.mean[c] > 0))
      throwInput("{}: the mean of a channel is 0; no ratio to it exists", location);
  const glm::dvec3 slope = standard / denominator.mean, value = slope * numerator.mean;
  const glm::dvec3 fromNumerator = slope * numerator.standardError;
  const glm::dvec3 fromDenominator = value * denominator.standardError / denominator.mean;
  return {value, glm::sqrt(fromNumerator * fromNumerator + fromDenominator * fromDenominator)};
}

}  // namespace chromeball
