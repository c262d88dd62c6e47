// SPDX-License-Identifier: Apache-2.0
// Values of settings, from a scene file, a command line or a program.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "front/setting.h"

namespace chromeball {

// The table of all settings of a render. The scene file's reader, the command line, --help and the
// reference page (docs/scene-file.md) are derived from it.

// To add a setting, add a row (setting_rows_*.cpp) and a member of RenderDescription that
// planRender() sets. A Compound also needs a reader (scene_file*.cpp).
const std::vector<Setting>& settingTable();

// A section of the scene file, in the order of the reference page; the section with the empty name
// contains the options that exist only on the command line.
struct SettingSection {
  std::string_view name;     // "render"
  std::string_view heading;  // "[render]"
  std::string_view title;    // of its options in --help
  std::string_view about;    // one paragraph (Markdown)
  std::vector<Setting> (*rows)();
  // Its keys are options too: flags, and settings that have an `argument`.
  bool keysAreOptions = false;
};
std::span<const SettingSection> settingSections();

// The keys of a section, in the table's order.
std::vector<std::string_view> keysOf(std::string_view section);

// The setting with a name ("render.samples", "clamp"). Throws std::logic_error if there is none.
const Setting& settingNamed(std::string_view name);

// nullptr if the section has no such key.
const Setting* findSetting(std::string_view section, std::string_view key);

// The parts of the table of settings.

std::vector<Setting> modelRows();
std::vector<Setting> cameraRows();
std::vector<Setting> probeRows();
std::vector<Setting> lightingRows();
std::vector<Setting> lightRows();
std::vector<Setting> sourceRows();
std::vector<Setting> renderRows();
std::vector<Setting> outputRows();
std::vector<Setting> compositeRows();
std::vector<Setting> surroundingsRows();
std::vector<Setting> commandRows();  // options without a key

// A row of one number, and one of a position in metres: they have readers of their own.
Setting numberRow(std::string_view key, const Range& range, std::string_view unit,
                  std::string_view absent, std::string_view help);
Setting pointRow(std::string_view key, std::string_view absent, std::string_view help);

// Adds rows with this effect to those of a section, as options of `chromeball render` alone.
void addRenderOnly(std::vector<Setting>& rows, Effect effect, std::vector<Setting> more);

inline constexpr Range kPositive{.min = 0, .excludesMin = true};
inline constexpr Range kNotNegative{.min = 0};
inline constexpr Range kSunAngle{.min = 0.01, .max = 90};

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
  void merge(const Settings& over);  // values of `over` replace this one's

  bool has(std::string_view name) const { return find(name) != nullptr; }
  const Given* find(std::string_view name) const;  // nullptr if not given
  std::string location(std::string_view name) const;

  // The value given, or the default.
  template <class T>
  T get(std::string_view name) const {
    const Given* given = find(name);
    return as<T>(name, given ? given->value : defaultOf(name));
  }
  // The enumerator (or false, true) of a Choice, whose row has the choices in the same order.
  template <class Enumerator>
  Enumerator choice(std::string_view name) const {
    return Enumerator(indexOfChoice(name));
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
  int indexOfChoice(std::string_view name) const;

  std::map<std::string, Given, std::less<>> given_;
};

// Whether [composite] has no plate.
bool isShadowCatcher(const Settings& settings);

// The reference page of the scene file.

// docs/scene-file.md, from the table of settings: every key with its type, range, unit, default,
// option and meaning.
std::string settingsPage();

// The default in words: "256", "the model's first camera", "off".
std::string defaultText(const Setting& setting);

}  // namespace chromeball
