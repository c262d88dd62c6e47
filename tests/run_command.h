// SPDX-License-Identifier: Apache-2.0
// Runs the command of this build.
#pragma once

#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "paths.h"
#include "temporary_folder.h"

struct CommandResult {
  int status = -1;  // exit status, or minus the number of the terminating signal
  std::string out, error;
};

std::string fileContents(const std::string& path);

// Resource limits of the command, in bytes; 0 is unlimited.
struct CommandLimits {
  size_t memory = 0;         // address space
  size_t fileSize = 0;       // of each written file; writing fails as on a full disk
  bool permissions = false;  // drop root's capability to ignore file permissions

  void apply() const;
};

// `status`: from waitpid().
CommandResult commandResult(int status, const std::string& outPath, const std::string& errorPath);

// Starts the executable itself. If `signalAt` is not empty, sends `signal` as soon as standard
// error contains it; and again as soon as that contains `againAt`.
CommandResult runExecutable(const std::vector<std::string>& arguments,
                            const std::string& signalAt = "", int signal = SIGINT,
                            const CommandLimits& limits = {}, const std::string& againAt = "");

// The same in the command server, which starts faster; the command line that a file states is
// wrong.
CommandResult runCommand(const std::vector<std::string>& arguments);

// Runs the command, under limits the executable, and expects an input error: status 2, nothing on
// standard output, and one line `chromeball: ...` that contains `reason`.
CommandResult expectError(const std::vector<std::string>& arguments, const std::string& reason,
                          const std::optional<CommandLimits>& limits = {});
