// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/message.h"
#include "base/text.h"
#include "scene_options.h"

namespace chromeball {

void warn(const std::string& text) { note("warning: " + text); }

void note(const std::string& text) { fmt::print(stderr, "chromeball: {}\n", printable(text)); }

void print(const Messages& messages, bool quiet) {
  for (const Message& message : condensed(messages)) {
    const std::string text = message.text + inWords(message.remedy);
    if (message.kind == Message::Kind::Warning)
      warn(text);
    else if (!quiet)
      note(text);
  }
}

std::string inWords(const std::optional<Remedy>& remedy) {
  if (!remedy) return "";
  return fmt::format("; {} {}", remedy->value.empty() ? "see" : "try",
                     optionText(settingNamed(remedy->setting), remedy->value));
}

}  // namespace chromeball
