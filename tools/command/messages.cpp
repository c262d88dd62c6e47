// SPDX-License-Identifier: Apache-2.0
#include "messages.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <ctime>

#include "base/message.h"
#include "base/text.h"
#include "scene_options.h"

namespace chromeball {
namespace {

// In the calling thread a pipe that nobody reads makes a write fail, instead of ending the process.
class BrokenPipesAreErrors {
 public:
  BrokenPipesAreErrors() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~BrokenPipesAreErrors() {
    const timespec now{};
    if (sigismember(&before_, SIGPIPE) == 0) sigtimedwait(&pipe_, nullptr, &now);
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  BrokenPipesAreErrors(const BrokenPipesAreErrors&) = delete;
  BrokenPipesAreErrors& operator=(const BrokenPipesAreErrors&) = delete;

 private:
  sigset_t pipe_, before_;
};

}  // namespace

Verbosity& verbosity() {
  static Verbosity given;
  return given;
}

void writeError(std::string_view text) {
  const BrokenPipesAreErrors pipes;
  std::fwrite(text.data(), 1, text.size(), stderr);
}

void warn(const std::string& text) { note("warning: " + text); }

void note(const std::string& text) { writeError(fmt::format("chromeball: {}\n", printable(text))); }

void print(const Messages& messages) {
  for (const Message& message : condensed(messages)) {
    const std::string text = message.text + inWords(message.remedy);
    if (message.kind == Message::Kind::Warning)
      warn(text);
    else if (!verbosity().quiet)
      note(text);
  }
}

std::string optionInWords(std::string_view setting, const std::string& value) {
  const Setting& row = settingNamed(setting);
  return value.empty() ? "--" + row.option : optionText(row, value);
}

std::string inWords(const std::optional<Remedy>& remedy) {
  if (!remedy) return "";
  const auto& table = settingTable();
  const auto setting = std::ranges::find(table, remedy->setting, &Setting::name);
  return fmt::format(
      "; {} {}", remedy->value.empty() ? "see" : "try",
      setting == table.end() ? "--" + remedy->setting : optionText(*setting, remedy->value));
}

}  // namespace chromeball
