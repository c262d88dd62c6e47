// SPDX-License-Identifier: Apache-2.0
// The library's messages on standard error. One that cannot be written is lost, and the work goes
// on.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "base/message.h"

namespace chromeball {

void warn(const std::string& text);  // "chromeball: warning: ..."; --quiet does not silence it
void note(const std::string& text);  // "chromeball: ...", printable() (base/text.h)

// The same with a format and its arguments.
template <class First, class... More>
void warn(fmt::format_string<First, More...> format, First&& first, More&&... more) {
  warn(fmt::vformat(format, fmt::make_format_args(first, more...)));
}
template <class First, class... More>
void note(fmt::format_string<First, More...> format, First&& first, More&&... more) {
  note(fmt::vformat(format, fmt::make_format_args(first, more...)));
}

// What --quiet and --progress of the command say that runs.
struct Verbosity {
  bool quiet = false, progress = false;
};
Verbosity& verbosity();

// Prints what a command found to standard output, unless it is quiet.
template <class... Arguments>
void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  if (!verbosity().quiet) fmt::print(format, std::forward<Arguments>(arguments)...);
}

// As it is: parts of lines, and controls of the terminal.
void writeError(std::string_view text);

// All warnings, and the notes unless the command is quiet; each with the option that resolves it.
void print(const Messages& messages);

// The option of a setting, for SettingWords (base/message.h): "--max-depth 8", "--clamp".
std::string optionInWords(std::string_view setting, const std::string& value);

// The end of a sentence: "; try --probe-scale 0.019", or "; see --memory GB"; empty without one.
std::string inWords(const std::optional<Remedy>& remedy);

}  // namespace chromeball
