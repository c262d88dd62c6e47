// SPDX-License-Identifier: Apache-2.0
#include "front/setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "front/arguments.h"
#include "front/synonyms.h"

namespace chromeball {
namespace {

using Type = SettingType;

constexpr SettingTypeInfo kTypeInfos[] = {
    {"flag", "true or false", 0},
    {"integer", "", 1},
    {"number", "", 2},
    {"number or `\"off\"`", "\"off\" or a factor, 0 or more", 2},
    {"number or `\"auto\"`", "", 4},
    {"", "", 3},
    {"name", "", 4},
    {"name, or an array", "", 5},
    {"string", "a string", 4},
    {"file", "a file name", 4},
    {"file or folder", "a name of a file or folder", 4},
    {"file, or an array", "a file name", 5},
    {"`[width, height]`", "[width, height]", 6},
    {"", "", std::variant_npos},
};
static_assert(std::size(kTypeInfos) == size_t(Type::Compound) + 1);

std::string describeRange(const Range& range, bool whole) {
  const auto number = [](double x) {
    return x == std::floor(x) && std::abs(x) < 1e15 ? fmt::format("{:.0f}", x)
                                                    : fmt::format("{:g}", x);
  };
  const bool hasMin = std::isfinite(range.min), hasMax = std::isfinite(range.max);
  const std::string kind = whole ? "a whole number" : hasMax ? "a number" : "a finite number";
  if (!hasMin && !hasMax) return kind;
  if (!hasMax)
    return kind + (range.excludesMin ? " above " + number(range.min)
                                     : ", " + number(range.min) + " or more");
  if (range.excludesMin && !range.excludesMax)
    return fmt::format("{} above {}, at most {}", kind, number(range.min), number(range.max));
  return fmt::format("{} {} {} {} {}", kind, range.excludesMin ? "between" : "from",
                     number(range.min), range.excludesMin ? "and" : "to", number(range.max));
}

[[noreturn]] void refuse(const Setting& setting, std::string_view text,
                         const std::string& location) {
  throwInput("{}: `{}` is not {}", location, printableName(text), expected(setting));
}

void checkChoice(const Setting& setting, const std::string& name, const std::string& location) {
  if (std::ranges::count(setting.choices, name) > 0) return;
  const std::string hint = hintOnValue(setting, name);
  throwInput("{}: `{}` is not known; {}", location, printableName(name),
             hint.empty() ? didYouMean(name, setting.choices) : hint);
}

// Names that only the code that uses them knows, but for those that are sure to be none.
void checkName(const Setting& setting, const std::string& name, const std::string& location) {
  if (name.empty()) throwInput("{}: is empty", location);
  if (const std::string hint = hintOnValue(setting, name); !hint.empty())
    throwInput("{}: `{}` is not known; {}", location, printableName(name), hint);
}

// Splits words at commas; each word may contain several names.
std::vector<std::string> split(const std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (const std::string& word : words)
    for (const std::string_view name : splitAt(word, ','))
      if (!name.empty()) names.emplace_back(name);
  return names;
}

double parseNumber(const Setting& setting, std::string text, const std::string& location) {
  if (setting.type == Type::Factor && text == "off") return 0;
  const std::string given = text;
  if (setting.unit == "percent" && text.ends_with('%')) text.pop_back();
  double number = 0;
  if (!toNumber(text, number)) refuse(setting, given, location);
  return number;
}

// Numbers separated by commas, or their name; an empty one is refused.
std::vector<double> parseList(const Setting& setting, const std::string& text,
                              const std::string& location) {
  if (const auto* named = numbersCalled(setting, text)) return *named;
  std::vector<double> numbers;
  for (const std::string_view part : splitAt(text, ','))
    if (!toNumber(part, numbers.emplace_back())) refuse(setting, text, location);
  return numbers;
}

void checkNumbers(const Setting& setting, const SettingValue& value, const std::string& location) {
  const auto& numbers = std::get<std::vector<double>>(value);
  if (std::ranges::count(setting.counts, numbers.size()) == 0)
    refuse(setting, toText(value), location);
  for (const double x : numbers)
    if (!(std::abs(x) <= FLT_MAX) || !setting.range.contains(x))
      throwInput("{}: `{}` is not {}", location, x, expectedNumber(setting, setting.range));
}

void checkNumberOrAuto(const Setting& setting, const std::string& text,
                       const std::string& location) {
  double x = 0;
  const bool isNumber = toNumber(text, x) && std::abs(x) <= FLT_MAX && setting.range.contains(x);
  if (text != "auto" && !isNumber) refuse(setting, text, location);
}

}  // namespace

std::string Setting::name() const {
  if (key.empty()) return option;
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

const SettingTypeInfo& infoOf(SettingType type) { return kTypeInfos[size_t(type)]; }

std::string expected(const Setting& s) {
  if (const std::string_view always = infoOf(s.type).expected; !always.empty())
    return std::string(always);
  const std::string unit = s.unit.empty() ? "" : fmt::format(" ({})", s.unit);
  if (s.type == Type::Integer || s.type == Type::Number)
    return describeRange(s.range, s.type == Type::Integer) + unit;
  if (s.type == Type::NumberOrAuto) return "auto or " + describeRange(s.range, false) + unit;
  if (s.type == Type::Choice) return fmt::format("one of {}", fmt::join(s.choices, ", "));
  if (s.type == Type::Choices)
    return fmt::format("one or several of {}", fmt::join(s.choices, ", "));
  return std::string(s.form);
}

std::string expectedNumber(Setting setting, const Range& range) {
  if (setting.type == Type::Compound || setting.type == Type::Numbers) setting.type = Type::Number;
  setting.range = range;
  return expected(setting);
}

const std::vector<double>* numbersCalled(const Setting& setting, std::string_view name) {
  const auto found = std::ranges::find(setting.named, name, &NamedNumbers::name);
  return found == setting.named.end() ? nullptr : &found->numbers;
}

SettingValue parseSetting(const Setting& setting, const std::vector<std::string>& words,
                          const std::string& location) {
  SettingValue value;
  const std::string text = words.empty() ? "" : words.back();
  switch (setting.type) {
    case Type::Flag:
      if (!text.empty() && text != "true" && text != "false") refuse(setting, text, location);
      value = text != "false";
      break;
    case Type::Integer: {
      uint64_t number = 0;
      if (!toNumber(text, number)) refuse(setting, text, location);
      value = number;
      break;
    }
    case Type::Number:
    case Type::Factor:
      value = parseNumber(setting, text, location);
      break;
    case Type::Numbers:
      value = parseList(setting, text, location);
      break;
    case Type::Choices:
      value = split(words);
      break;
    case Type::Files:
      value = words;
      break;
    case Type::Size:
      value = parseSize(text, location);
      break;
    default:
      value = text;
  }
  checkSetting(setting, value, location);
  return value;
}

void checkSetting(const Setting& setting, const SettingValue& value, const std::string& location) {
  if (setting.type == Type::Compound)
    throwInput("{}: `{}` belongs into a scene file", location, setting.name());
  if (value.index() != infoOf(setting.type).alternative) refuse(setting, toText(value), location);
  switch (setting.type) {
    case Type::Integer:
      if (!setting.range.contains(double(std::get<uint64_t>(value))))
        refuse(setting, toText(value), location);
      return;
    case Type::Number:
    case Type::Factor:
      if (const double x = std::get<double>(value);
          !(std::abs(x) <= FLT_MAX) || !setting.range.contains(x))
        refuse(setting, toText(value), location);
      return;
    case Type::NumberOrAuto:
      return checkNumberOrAuto(setting, std::get<std::string>(value), location);
    case Type::Numbers:
      return checkNumbers(setting, value, location);
    case Type::Choice:
      return checkChoice(setting, std::get<std::string>(value), location);
    case Type::Choices:
      for (const std::string& name : std::get<std::vector<std::string>>(value))
        checkChoice(setting, name, location);
      return;
    case Type::Name:
    case Type::File:
    case Type::Source:
      return checkName(setting, std::get<std::string>(value), location);
    default:
      return;
  }
}

std::string toText(const SettingValue& value) {
  struct {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(uint64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return fmt::format("{}", number); }
    std::string operator()(const std::vector<double>& numbers) const {
      return fmt::format("{}", fmt::join(numbers, ","));
    }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(const std::vector<std::string>& names) const {
      return fmt::format("{}", fmt::join(names, ","));
    }
    std::string operator()(const ImageSize& size) const {
      return fmt::format("{}x{}", size.width, size.height);
    }
  } format;
  return std::visit(format, value);
}

}  // namespace chromeball
