// SPDX-License-Identifier: Apache-2.0
#include "front/arguments.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

constexpr size_t kMaxGaussians = 32;
constexpr std::array<std::string_view, 6> kNames = {"clip",  "depth-blur", "motion",
                                                    "bloom", "glare",      "vignette"};

double numberIn(std::string_view text, double min, double max, std::string_view what,
                std::string_view location) {
  const double number = parseNumbers(text, 1, location).front();
  if (!(number >= min && number <= max))
    throwInput("{}: the {} {:g} should be {:g} to {:g}", location, what, number, min, max);
  return number;
}

struct Halves {
  std::string_view before, after;
};

Halves split(std::string_view text, char separator, std::string_view form,
             std::string_view location) {
  const size_t at = text.find(separator);
  if (at == std::string_view::npos) throwInput("{}: `{}` is not {}", location, text, form);
  return {text.substr(0, at), text.substr(at + 1)};
}

std::vector<WeightedGaussian> parseBloom(std::string_view text, std::string_view location) {
  constexpr double kTolerance = 0.01;
  std::vector<WeightedGaussian> mixture;
  double sum = 0;
  for (const std::string_view part : splitAt(text, ',')) {
    const auto [weight, sigma] = split(part, ':', "WEIGHT:SIGMA, as in .75:1,.25:32", location);
    mixture.push_back({numberIn(weight, 0, 1, "weight", location),
                       numberIn(sigma, 0, kMaxSigma, "sigma (pixels)", location)});
    sum += mixture.back().weight;
    if (mixture.size() > kMaxGaussians)
      throwInput("{}: has more than {} Gaussians", location, kMaxGaussians);
  }
  if (std::fabs(sum - 1) > kTolerance)
    throwInput("{}: the weights sum to {:g}; they should sum to 1, to keep the image's energy",
               location, sum);
  for (WeightedGaussian& gaussian : mixture) gaussian.weight /= sum;
  return mixture;
}

Motion parseMotion(std::string_view text, std::string_view location) {
  const auto [length, angle] = split(text, '@', "LENGTH@ANGLE, as in 60@0", location);
  return {numberIn(length, 0, kMaxMotion, "length (pixels)", location),
          numberIn(angle, -360, 360, "angle (degrees)", location)};
}

ThinLens parseLens(std::string_view text, std::string_view location) {
  constexpr double kSmallest = 1e-6, kLargest = 1e6, kLargestAperture = 1e3;
  const auto [focus, aperture] = split(text, ':', "FOCUS:APERTURE, as in 2.5:0.05", location);
  return {numberIn(focus, kSmallest, kLargest, "focus (metres)", location),
          numberIn(aperture, 0, kLargestAperture, "aperture (metres)", location)};
}

float parseClip(std::string_view text, std::string_view location) {
  const double clip = parseNumbers(text, 1, location).front();
  if (!isPositiveFloat(clip)) throwInput("{}: {:g} should be {}", location, clip, kPositiveFloats);
  return float(clip);
}

}  // namespace

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

void setDevelop(DevelopSettings& settings, std::string_view name, std::string_view text,
                std::string_view location) {
  if (name == "clip") {
    settings.clip = parseClip(text, location);
  } else if (name == "depth-blur") {
    settings.lens = parseLens(text, location);
  } else if (name == "motion") {
    settings.motion = parseMotion(text, location);
  } else if (name == "bloom") {
    settings.bloom = parseBloom(text, location);
  } else if (name == "glare") {
    if (text != "spencer")
      throwInput("{}: `{}` is not known; {}", location, text, didYouMean(text, {"spencer"}));
    settings.glare = true;
  } else {
    assert(name == "vignette");
    settings.vignette = numberIn(text, 0, 1, "strength", location);
  }
}

DevelopSettings parseDevelop(std::string_view text, std::string_view location) {
  constexpr std::string_view kSpaces = " \t\n";
  DevelopSettings settings;
  std::set<std::string_view> names;
  for (size_t begin = text.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kSpaces, begin), text.size());
    const auto [name, value] =
        split(text.substr(begin, end - begin), '=',
              "NAME=VALUE, as in vignette=.4 or bloom=.75:1,.25:32", location);
    if (!names.insert(name).second) throwInput("{}: `{}` is there twice", location, name);
    if (std::ranges::find(kNames, name) == kNames.end())
      throwInput("{}: `{}` is not known; {}", location, name,
                 didYouMean(name, {kNames.begin(), kNames.end()}));
    setDevelop(settings, name, value, fmt::format("{}: {}", location, name));
    begin = text.find_first_not_of(kSpaces, end);
  }
  return settings;
}

}  // namespace chromeball
