// SPDX-License-Identifier: Apache-2.0
#include "job/arguments.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/suggest.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

// Reads a number from the front of `text` and removes it.
template <class Number>
bool takeNumber(std::string_view& text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return false;
  text.remove_prefix(end - text.data());
  return true;
}

bool takeLetter(std::string_view& text, char letter) {
  if (text.empty() || text.front() != letter) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

ImageSize parseSize(std::string_view text, std::string_view location) {
  constexpr int kLargest = 65536;
  const auto inRange = [](int side) { return side >= 1 && side <= kLargest; };
  ImageSize size{};
  std::string_view rest = text;
  if (takeNumber(rest, size.width) && takeLetter(rest, 'x') && takeNumber(rest, size.height) &&
      rest.empty() && inRange(size.width) && inRange(size.height)) {
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
  std::vector<double> numbers(count);
  std::string_view rest = text;
  bool valid = true;
  for (size_t i = 0; i < count && valid; ++i)
    valid = (i == 0 || takeLetter(rest, ',')) && takeNumber(rest, numbers[i]) &&
            std::isfinite(numbers[i]);
  if (valid && rest.empty()) return numbers;
  if (count == 1) throwInput("{}: `{}` is not a number", location, text);
  throwInput("{}: `{}` is not {} numbers with commas between them", location, text, count);
}

}  // namespace chromeball
