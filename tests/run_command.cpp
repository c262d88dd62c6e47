// SPDX-License-Identifier: Apache-2.0
#include "run_command.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "command_server.h"

std::string fileContents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void CommandLimits::apply() const {
  const rlimit addressSpace{memory, memory}, file{fileSize, fileSize};
  if (memory) setrlimit(RLIMIT_AS, &addressSpace);
  if (fileSize) setrlimit(RLIMIT_FSIZE, &file);
  if (permissions)
    for (int capability : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH})
      prctl(PR_CAPBSET_DROP, capability);
}

CommandResult commandResult(int status, const std::string& outPath, const std::string& errorPath) {
  CommandResult result;
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.out = fileContents(outPath);
  result.error = fileContents(errorPath);
  return result;
}

CommandResult runExecutable(const std::vector<std::string>& arguments, const std::string& signalAt,
                            int signal, const CommandLimits& limits, const std::string& againAt) {
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
  for (const std::string& text : {signalAt, againAt}) {
    if (text.empty()) break;
    while (!ended && fileContents(errorPath).find(text) == std::string::npos) {
      usleep(10000);
      ended = waitpid(child, &status, WNOHANG) == child;
    }
    if (!ended) kill(child, signal);
  }
  if (!ended) waitpid(child, &status, 0);
  return commandResult(status, outPath, errorPath);
}

CommandResult runCommand(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const std::string outPath = folder / "out", errorPath = folder / "error";
  std::vector<std::string> words{kCommand};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return commandResult(runInServer(words, outPath, errorPath), outPath, errorPath);
}

CommandResult expectError(const std::vector<std::string>& arguments, const std::string& reason,
                          const std::optional<CommandLimits>& limits) {
  const CommandResult result =
      limits ? runExecutable(arguments, "", SIGINT, *limits) : runCommand(arguments);
  EXPECT_EQ(result.status, 2) << result.error;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(result.error.starts_with("chromeball: ")) << result.error;
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  return result;
}
