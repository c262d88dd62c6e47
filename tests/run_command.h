// SPDX-License-Identifier: Apache-2.0
// Runs the command of this build.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "command_server.h"
#include "paths.h"
#include "temporary_folder.h"

struct CommandResult {
  int status = -1;  // exit status, or minus the number of the terminating signal
  std::string out, error;
};

inline std::string fileContents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Resource limits of the command, in bytes; 0 is unlimited.
struct CommandLimits {
  size_t memory = 0;         // address space
  size_t fileSize = 0;       // of each written file; writing fails as on a full disk
  bool permissions = false;  // drop root's capability to ignore file permissions

  void apply() const {
    const rlimit addressSpace{memory, memory}, file{fileSize, fileSize};
    if (memory) setrlimit(RLIMIT_AS, &addressSpace);
    if (fileSize) setrlimit(RLIMIT_FSIZE, &file);
    if (permissions)
      for (int capability : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH})
        prctl(PR_CAPBSET_DROP, capability);
  }
};

inline CommandResult commandResult(int status, const std::string& outPath,
                                   const std::string& errorPath) {
  CommandResult result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.out = fileContents(outPath);
  result.error = fileContents(errorPath);
  return result;
}

// Starts the executable itself. If `signalAt` is not empty, sends `signal` as soon as standard
// error contains it.
inline CommandResult runExecutable(const std::vector<std::string>& arguments,
                                   const std::string& signalAt = "", int signal = SIGINT,
                                   const CommandLimits& limits = {}) {
  const TemporaryFolder folder;
  const std::string outPath = folder / "out", errorPath = folder / "error";
  std::vector<char*> argv{const_cast<char*>(kCommand)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    limits.apply();
    dup2(open(outPath.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(errorPath.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  bool ended = false;
  while (!signalAt.empty() && !ended &&
         fileContents(errorPath).find(signalAt) == std::string::npos) {
    usleep(10000);
    ended = waitpid(child, &status, WNOHANG) == child;
  }
  if (!signalAt.empty() && !ended) kill(child, signal);
  if (!ended) waitpid(child, &status, 0);
  return commandResult(status, outPath, errorPath);
}

// The same in the command server, which starts faster; what a file says of its command line is
// wrong.
inline CommandResult runCommand(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string outPath = folder / "out", errorPath = folder / "error";
  std::vector<std::string> words{kCommand};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return commandResult(runInServer(words, outPath, errorPath), outPath, errorPath);
}

// Runs the command, under limits the executable, and expects an input error: status 2, nothing on
// standard output, and one line `chromeball: ...` that contains `reason`.
inline CommandResult expectError(const std::vector<std::string>& arguments,
                                 const std::string& reason,
                                 const std::optional<CommandLimits>& limits = {}) {
  const CommandResult result =
      limits ? runExecutable(arguments, "", SIGINT, *limits) : runCommand(arguments);
  EXPECT_EQ(result.status, 2) << result.error;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.error.starts_with("chromeball: ")) << result.error;
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  return result;
}
