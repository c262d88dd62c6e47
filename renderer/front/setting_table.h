// SPDX-License-Identifier: Apache-2.0
// The table of all settings of a render. The scene file's reader, the command line, --help and the
// reference page (docs/scene-file.md) are derived from it.
#pragma once

#include <span>

#include "front/setting.h"

namespace chromeball {

// To add a setting, add a row (setting_rows_*.cpp) and a member of RenderDescription that planJob()
// sets. A Compound also needs a reader (scene_file*.cpp).
const std::vector<Setting>& settingTable();

// A section of the scene file, in the order of the reference page; the section with the empty name
// contains the options that exist only on the command line.
struct SettingSection {
  std::string_view name;     // "render"
  std::string_view heading;  // "[render]"
  std::string_view title;    // of its options in --help
  std::string_view about;    // one paragraph (Markdown)
};
std::span<const SettingSection> settingSections();

// The keys of a section, in the table's order.
std::vector<std::string_view> keysOf(std::string_view section);

// By its name ("render.samples", "clamp"). Throws std::logic_error if there is none.
const Setting& settingNamed(std::string_view name);

// nullptr if the section has no such key.
const Setting* findSetting(std::string_view section, std::string_view key);

// The parts of the table of settings.

std::vector<Setting> sceneRows();      // [[model]], [camera], [probe], [lighting]
std::vector<Setting> lightRows();      // [[light]]
std::vector<Setting> sourceRows();     // [[source]]
std::vector<Setting> renderRows();     // [render], [output]
std::vector<Setting> compositeRows();  // [composite], [surroundings]
std::vector<Setting> commandRows();    // options without a key

inline constexpr Range kPositive{.min = 0, .excludesMin = true};
inline constexpr Range kNotNegative{.min = 0};
inline constexpr Range kSunAngle{.min = 0.01, .max = 90};

}  // namespace chromeball
