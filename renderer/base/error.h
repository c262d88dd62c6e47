// SPDX-License-Identifier: Apache-2.0
// The exceptions that end a run. The command prints each as one line and returns an exit status.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "base/message.h"

namespace chromeball {

// The user's input is wrong: arguments, scene, model, probe (exit status 2). The message reads
// "FILE[:LINE]: the mistake, and valid input".
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
  InputError(const std::string& message, Remedy r) : runtime_error(message), remedy(std::move(r)) {}

  std::optional<Remedy> remedy;
};

// Something failed while running, such as a full disk (exit status 1).
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The user stopped the run; the work done so far is saved where that was asked for (exit status
// 130).
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Not templates, to keep what each call adds to the program small.
[[noreturn]] inline void throwFormattedInput(fmt::string_view format, fmt::format_args arguments) {
  throw InputError(fmt::vformat(format, arguments));
}
[[noreturn]] inline void throwFormattedRun(fmt::string_view format, fmt::format_args arguments) {
  throw RunError(fmt::vformat(format, arguments));
}

template <class... Args>
[[noreturn]] void throwInput(fmt::format_string<Args...> format, Args&&... args) {
  throwFormattedInput(format, fmt::make_format_args(args...));
}

template <class... Args>
[[noreturn]] void throwRun(fmt::format_string<Args...> format, Args&&... args) {
  throwFormattedRun(format, fmt::make_format_args(args...));
}

}  // namespace chromeball
