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
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "command_server.h"
#include "paths.h"

// A temporary folder, removed with its contents by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "chromeball-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

 private:
  std::filesystem::path path_;
};

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

// Expects of a run an input error: status 2, nothing on standard output, and one line
// `chromeball: ...` that contains `reason`.
inline void expectInputError(const CommandResult& result, const std::string& reason) {
  EXPECT_EQ(result.status, 2) << result.error;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.error.starts_with("chromeball: ")) << result.error;
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
}

inline CommandResult expectError(const std::vector<std::string>& arguments,
                                 const std::string& reason) {
  const CommandResult result = runCommand(arguments);
  expectInputError(result, reason);
  return result;
}
inline CommandResult expectError(const std::vector<std::string>& arguments,
                                 const std::string& reason, const CommandLimits& limits) {
  const CommandResult result = runExecutable(arguments, "", SIGINT, limits);
  expectInputError(result, reason);
  return result;
}
