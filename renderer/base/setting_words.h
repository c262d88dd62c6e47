// SPDX-License-Identifier: Apache-2.0
// The words of messages for settings. The library knows no options of the command.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>

namespace chromeball {

// How messages call a setting of the table (front/settings.h: "render.max_depth"), with a value or,
// if that is empty, without. The command's is "--max-depth 8".
using SettingWords = std::function<std::string(std::string_view setting, const std::string& value)>;

// "`render.max_depth` 8"
inline std::string plainWords(std::string_view setting, const std::string& value) {
  return fmt::format("`{}`{}{}", setting, value.empty() ? "" : " ", value);
}

}  // namespace chromeball
