// SPDX-License-Identifier: Apache-2.0
// Runs the command line in forks of itself for the tests, which start it more than a thousand
// times. Its argument is the name of a socket. Each connection is one run: it sends strings that
// end with 0 (the files for standard output and standard error, the working folder, the number of
// arguments, the arguments, and the environment), then nothing more, and gets the status of
// waitpid(). Ends when standard input does, that is, with the process that started it.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "command_line.h"

namespace {

std::vector<char*> readStrings(int connection, std::string& text) {
  char buffer[4096];
  for (ssize_t count; (count = read(connection, buffer, sizeof buffer)) > 0;)
    text.append(buffer, size_t(count));
  std::vector<char*> strings;
  for (size_t begin = 0, end; (end = text.find('\0', begin)) != std::string::npos; begin = end + 1)
    strings.push_back(&text[begin]);
  return strings;
}

// Does not return.
void runCommand(const std::vector<char*>& strings) {
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(open(strings[0], O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
  dup2(open(strings[1], O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
  if (chdir(strings[2]) != 0) _exit(127);
  const auto arguments = strings.begin() + 4, environment = arguments + std::atoi(strings[3]);
  clearenv();
  for (auto variable = environment; variable != strings.end(); ++variable) putenv(*variable);
  std::vector<char*> argv(arguments, environment);
  argv.push_back(nullptr);
  const int status = chromeball::runCommandLine(int(argv.size()) - 1, argv.data());
  std::fflush(nullptr);
  // Not exit(): libraries would join threads that only the server has.
  _exit(status);
}

// In a process of its own, which ends with the run.
void serve(int connection) {
  std::signal(SIGCHLD, SIG_DFL);
  std::string text;
  const std::vector<char*> strings = readStrings(connection, text);
  const pid_t child = fork();
  if (child == 0) runCommand(strings);
  int status = 0;
  waitpid(child, &status, 0);
  _exit(write(connection, &status, sizeof status) == sizeof status ? 0 : 1);
}

int listenAt(const char* name) {
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  std::strncpy(address.sun_path, name, sizeof address.sun_path - 1);
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener, 64) != 0)
    std::exit(1);
  return listener;
}

}  // namespace

int main(int, char** argv) {
  const int listener = listenAt(argv[1]);
  std::signal(SIGCHLD, SIG_IGN);
  const char ready = 1;
  if (write(STDOUT_FILENO, &ready, 1) != 1) return 1;
  while (true) {
    pollfd events[] = {{listener, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    poll(events, 2, -1);
    if (events[1].revents) return 0;
    if (!events[0].revents) continue;
    const int connection = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (fork() == 0) serve(connection);
    close(connection);
  }
}
