// SPDX-License-Identifier: Apache-2.0
// One setting of a render: its names, type, range and meaning.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "probe/mapping.h"

namespace chromeball {

// Flag: bool. Integer: uint64_t. Number and Factor: double. Numbers: a list of doubles. Choice,
// NumberOrAuto, Name and File: string. Choices and Files: a list of strings. Size: ImageSize.
using SettingValue = std::variant<bool, uint64_t, double, std::vector<double>, std::string,
                                  std::vector<std::string>, ImageSize>;

enum class SettingType {
  Flag,
  Integer,       // whole, in the range
  Number,        // finite as a float, in the range
  Factor,        // the same; "off" is 0
  NumberOrAuto,  // the text of a Number, or "auto"
  Numbers,       // one or several such numbers; `form` describes them
  Choice,        // one of the choices
  Choices,       // one or several of the choices
  Name,          // a string, validated by the code that uses it
  File,          // an existing file
  Source,        // an existing file or folder
  Files,         // one or several files to write
  Size,          // width and height in pixels
  Compound,      // a structured key with its own reader; `form` describes it
};

// What the settings of a type have in common.
struct SettingTypeInfo {
  std::string_view form;      // in the reference page; empty: the setting's own
  std::string_view expected;  // describes valid values; empty: these depend on the setting
  size_t alternative;         // of SettingValue
};
const SettingTypeInfo& infoOf(SettingType type);

// The range of an Integer, of a Number, or of the elements of Numbers or a Compound.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool excludesMin = false, excludesMax = false;

  bool contains(double x) const {
    return (excludesMin ? x > min : x >= min) && (excludesMax ? x < max : x <= max);
  }
};

struct NamedNumbers {
  std::string_view name;
  std::vector<double> numbers;
};

// The effect of a setting.
enum class Effect {
  Image,    // changes the radiance of pixels: part of the description
  Limit,    // changes the number of samples
  Display,  // changes the tone mapping of a .png
  Run,      // does not change the image
};

struct Setting {
  std::string_view section;  // of the scene file; empty: none
  std::string_view key;      // empty: the command line only
  std::string option;        // without dashes; empty: the scene file only
  char letter = 0;           // short form of the option
  // The name of the option's argument in --help: "SECONDS"; a row that gives none has "N" for an
  // Integer, "NAME" for a Choice.
  std::string_view argument = {};
  std::string_view bare = {};  // the value of an option without "=ARGUMENT"; empty: not allowed
  SettingType type;
  std::string_view form = {};            // of a Compound or of Numbers: "three numbers"
  std::vector<size_t> counts = {};       // of Numbers: how many there may be
  std::vector<NamedNumbers> named = {};  // of Numbers: names for some of them
  Range range = {};
  std::string_view unit = {};
  std::string fallback = {};     // the default, in the syntax of the option; empty: none
  std::string_view absent = {};  // if there is no default: describes the behaviour without a value
  std::vector<std::string_view> choices = {};  // listed also for a Name
  std::string_view help;
  Effect effect = Effect::Image;
  bool renderOnly = false;  // not an option of `chromeball compare`, which varies or ignores it

  // The name: "render.samples"; the option if there is no key.
  std::string name() const;
};

// Describes valid values: "a whole number from 1 to 20", "a finite number above 0 (seconds)".
std::string expected(const Setting& setting);
// The same for one number of the setting, in another range.
std::string expectedNumber(Setting setting, const Range& range);

// The numbers with this name among the setting's; nullptr if there are none.
const std::vector<double>* numbersCalled(const Setting& setting, std::string_view name);

// The value of an option's arguments (none for a flag). Throws InputError, begun by `location`.
SettingValue parseSetting(const Setting& setting, const std::vector<std::string>& words,
                          const std::string& location);

// Throws InputError, begun by `location`, for a value of another type or out of range.
void checkSetting(const Setting& setting, const SettingValue& value, const std::string& location);

// The value in the syntax of the option.
std::string toText(const SettingValue& value);

}  // namespace chromeball
