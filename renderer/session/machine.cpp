// SPDX-License-Identifier: Apache-2.0
#include "session/machine.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

#include "base/parallel.h"

namespace chromeball {
namespace {

// The rest of the first line of a file that begins with `key`, after `separator`.
std::string lineIn(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key)) {
      const size_t begin = line.find_first_not_of(" \t\"", line.find(separator) + 1);
      const size_t end = line.find_last_not_of(" \t\"") + 1;
      return begin < end ? line.substr(begin, end - begin) : "";
    }
  return "";
}

std::string shellWord(const std::string& argument) {
  const bool plain = !argument.empty() && argument.find_first_not_of(
                                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                              "0123456789-_=+,./:@%") == std::string::npos;
  if (plain) return argument;
  std::string result = "'";
  for (const char c : argument) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

#ifdef __clang__
constexpr const char* kCompiler = "clang++ " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

// (getrusage() would include what the process that started this one had.)
uint64_t peakMemoryBytes() {
  return 1024 * std::strtoull(lineIn("/proc/self/status", "VmHWM", ':').c_str(), nullptr, 10);
}

std::string commandLine() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string command;
  for (std::string argument; std::getline(file, argument, '\0');)
    command += fmt::format("{}{}", command.empty() ? "" : " ", shellWord(argument));
  return command;
}

Machine thisMachine() {
  Machine machine;
  machine.processor = lineIn("/proc/cpuinfo", "model name", ':');
  utsname name{};
  uname(&name);
  machine.system = lineIn("/etc/os-release", "PRETTY_NAME", '=') + ", " + name.sysname + " " +
                   name.release + ", " + name.machine;
  machine.compiler = kCompiler;
  const std::time_t now = std::time(nullptr);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
  machine.date = date;
  machine.threads = threadCount();
  machine.command = commandLine();
  return machine;
}

}  // namespace chromeball
