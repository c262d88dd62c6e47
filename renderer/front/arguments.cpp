// SPDX-License-Identifier: Apache-2.0
#include "front/arguments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"
#include "image/size_limits.h"

namespace chromeball {

ImageSize parseSize(std::string_view text, std::string_view location) {
  constexpr int kLargest = 65536;
  const auto inRange = [](int side) { return side >= 1 && side <= kLargest; };
  ImageSize size{};
  const auto sides = splitAt(text, 'x');
  if (sides.size() == 2 && toNumber(sides[0], size.width) && toNumber(sides[1], size.height) &&
      inRange(size.width) && inRange(size.height)) {
    checkImageSize(location, size.width, size.height, 3);
    return size;
  }
  throwInput("{}: `{}` is not WIDTHxHEIGHT, each 1 to {}, as in 1024x512", location, text,
             kLargest);
}

LightUnits parseLightUnits(const NamedSetting& setting) {
  if (setting.name == "photometric") return LightUnits::Photometric;
  if (setting.name == "radiometric") return LightUnits::Radiometric;
  throwInput("{}: `{}` is not known; {}", setting.location, setting.name,
             didYouMean(setting.name, {"photometric", "radiometric"}));
}

std::vector<double> parseNumbers(std::string_view text, size_t count, std::string_view location) {
  std::vector<double> numbers;
  const auto parts = splitAt(text, ',');
  const bool valid = std::ranges::all_of(parts, [&](std::string_view part) {
    return toNumber(part, numbers.emplace_back()) && std::isfinite(numbers.back());
  });
  if (valid && parts.size() == count) return numbers;
  if (count == 1) throwInput("{}: `{}` is not a number", location, text);
  throwInput("{}: `{}` is not {} numbers with commas between them", location, text, count);
}

bool isPositiveFloat(double number) {
  return float(number) > 0 && number <= double(std::numeric_limits<float>::max());
}

glm::dvec3 colorOf(const std::vector<double>& numbers) {
  return {numbers.front(), numbers[numbers.size() / 2], numbers.back()};
}

Rgb parseColor(std::string_view text, std::string_view location) {
  const auto commas = std::ranges::count(text, ',');
  if (commas != 0 && commas != 2)
    throwInput("{}: `{}` should be one number, or three with commas between them", location, text);
  const std::vector<double> channels = parseNumbers(text, size_t(commas) + 1, location);
  for (const double channel : channels)
    if (channel != 0 && !isPositiveFloat(channel))
      throwInput("{}: {} should be not negative: 0, or {}", location, text, kPositiveFloats);
  return colorOf(channels);
}

Rotation parseRotation(const std::vector<double>& numbers, std::string_view location) {
  if (numbers.size() == 1) return Rotation(float(numbers[0]));
  if (numbers.size() == 3) return Rotation::ofAngles({numbers[0], numbers[1], numbers[2]});
  const glm::dquat quaternion(numbers[3], numbers[0], numbers[1], numbers[2]);
  constexpr double kRounding = 0.01;
  if (!(std::abs(glm::length(quaternion) - 1) <= kRounding))
    throwInput("{}: the quaternion ({}) has the length {:.4g}; it should be 1", location,
               fmt::join(numbers, ", "), glm::length(quaternion));
  return Rotation::ofQuaternion(quaternion);
}

Rotation parseRotation(std::string_view text, std::string_view location) {
  const size_t count = size_t(std::ranges::count(text, ',')) + 1;
  if (count != 1 && count != 3 && count != 4)
    throwInput("{}: `{}` should be YAW or YAW,PITCH,ROLL in degrees, or a quaternion X,Y,Z,W",
               location, text);
  const std::vector<double> numbers = parseNumbers(text, count, location);
  for (const double number : numbers)
    if (!(std::abs(number) <= double(std::numeric_limits<float>::max())))
      throwInput("{}: {} is too large", location, number);
  return parseRotation(numbers, location);
}

}  // namespace chromeball
