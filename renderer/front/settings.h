// SPDX-License-Identifier: Apache-2.0
// Values of settings, from a scene file, a command line or a program.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "front/setting_table.h"

namespace chromeball {

// Values by the names of the table of settings ("render.samples"), each with the location of its
// origin: FILE:LINE, "--samples", or empty. Throws std::logic_error for a name that is not in the
// table, or for the wrong type: mistakes of the calling code.
class Settings {
 public:
  struct Given {
    SettingValue value;
    std::string location;  // begins an error about the value
  };

  // Throws InputError, begun by the location, for a value out of range.
  void set(std::string_view name, SettingValue value, std::string location = {});
  // Sets the value from text in the syntax of the option.
  void parse(std::string_view name, const std::string& text);

  void erase(std::string_view name);
  void merge(const Settings& over);  // values of `over` replace those of this

  bool has(std::string_view name) const { return find(name) != nullptr; }
  const Given* find(std::string_view name) const;  // nullptr if not given
  std::string location(std::string_view name) const;

  // The value given, or the default.
  template <class T>
  T get(std::string_view name) const {
    const Given* given = find(name);
    return as<T>(name, given ? given->value : defaultOf(name));
  }
  // The value given, else the default, else nothing.
  std::optional<SettingValue> value(std::string_view name) const;
  template <class T>
  std::optional<T> getIfGiven(std::string_view name) const {
    const Given* given = find(name);
    return given ? std::optional(as<T>(name, given->value)) : std::nullopt;
  }

 private:
  template <class T>
  static T as(std::string_view name, const SettingValue& value) {
    if (const T* typed = std::get_if<T>(&value)) return *typed;
    throw std::logic_error("setting " + std::string(name) + " has another type");
  }
  static SettingValue defaultOf(std::string_view name);

  std::map<std::string, Given, std::less<>> given_;
};

// Whether [composite] has no plate.
bool isShadowCatcher(const Settings& settings);

}  // namespace chromeball
