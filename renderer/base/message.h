// SPDX-License-Identifier: Apache-2.0
// Messages of the library to its user. The library itself prints nothing.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chromeball {

// The setting that resolves what an error or a message is about, by its name in the table of
// settings (front/settings.h: "probe.scale"), or an option of the command that is not in it
// ("resize"). The command prints the option.
struct Remedy {
  std::string setting;
  std::string value;  // one that would do; empty: unknown
};

struct Message {
  enum class Kind {
    Note,     // something detected or chosen
    Warning,  // something that may spoil the image
  };
  Kind kind;
  std::string text;  // one line, without a full stop
  std::optional<Remedy> remedy = {};
};

using Messages = std::vector<Message>;

template <class... Args>
Message makeNote(fmt::format_string<Args...> format, Args&&... args) {
  return {Message::Kind::Note, fmt::format(format, std::forward<Args>(args)...)};
}
template <class... Args>
Message makeWarning(fmt::format_string<Args...> format, Args&&... args) {
  return {Message::Kind::Warning, fmt::format(format, std::forward<Args>(args)...)};
}
template <class... Args>
void addNote(Messages& messages, fmt::format_string<Args...> format, Args&&... args) {
  messages.push_back(makeNote(format, std::forward<Args>(args)...));
}
template <class... Args>
void addWarning(Messages& messages, fmt::format_string<Args...> format, Args&&... args) {
  messages.push_back(makeWarning(format, std::forward<Args>(args)...));
}

// The messages for a terminal: where more than three differ only in numbers and in quoted names,
// only the first, with a count of the others.
Messages condensed(const Messages& messages);

// The words of messages for settings. The library knows no options of the command.

// How messages call a setting of the table (front/settings.h: "render.max_depth"), with a value or,
// if that is empty, without. The command's is "--max-depth 8".
using SettingWords = std::function<std::string(std::string_view setting, const std::string& value)>;

// "`render.max_depth` 8"
inline std::string plainWords(std::string_view setting, const std::string& value) {
  return fmt::format("`{}`{}{}", setting, value.empty() ? "" : " ", value);
}

}  // namespace chromeball
