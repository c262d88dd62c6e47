// SPDX-License-Identifier: Apache-2.0
#include "command_server.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "paths.h"
#include "temporary_folder.h"

namespace {

void check(bool isRight, const char* what) {
  if (!isRight) throw std::runtime_error(std::string("command server: ") + what);
}

// The process. It lives as long as this one, whose end closes its standard input.
class CommandServer {
 public:
  CommandServer() {
    int input[2], output[2];
    check(pipe2(input, O_CLOEXEC) == 0 && pipe2(output, O_CLOEXEC) == 0, "pipe");
    const pid_t child = fork();
    if (child == 0) {
      dup2(input[0], STDIN_FILENO);
      dup2(output[1], STDOUT_FILENO);
      execl(kCommandServer, kCommandServer, socket_.c_str(), nullptr);
      _exit(127);
    }
    close(input[0]);
    close(output[1]);  // so that read() ends if the server does not start
    char ready = 0;
    check(read(output[0], &ready, 1) == 1, "no start");
    close(output[0]);
  }

  int connect() const {
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    std::strncpy(address.sun_path, socket_.c_str(), sizeof address.sun_path - 1);
    const int connection = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    check(::connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0,
          "connect");
    return connection;
  }

 private:
  TemporaryFolder folder_;
  std::string socket_ = folder_ / "socket";
};

}  // namespace

int runInServer(const std::vector<std::string>& arguments, const std::string& outPath,
                const std::string& errorPath) {
  static const CommandServer server;
  std::string text;
  const auto add = [&](const std::string& string) { text += string + '\0'; };
  add(outPath);
  add(errorPath);
  add(std::filesystem::current_path());
  add(std::to_string(arguments.size()));
  for (const std::string& argument : arguments) add(argument);
  for (char** variable = environ; *variable; ++variable) add(*variable);

  const int connection = server.connect();
  for (size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(connection, text.data() + sent, text.size() - sent);
    check(count > 0, "write");
    sent += size_t(count);
  }
  shutdown(connection, SHUT_WR);
  int status = 0;
  check(read(connection, &status, sizeof status) == sizeof status, "no answer");
  close(connection);
  return status;
}
