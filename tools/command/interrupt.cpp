// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <unistd.h>

#include <csignal>
#include <cstring>

namespace chromeball {

std::atomic<bool> interrupted = false, leaving = false;

namespace {

std::atomic<const char*> line = "";

void writeLine(const char* text) {  // a signal handler must not print
  for (const char* part : {"\nchromeball: ", text, "\n"})
    if (write(STDERR_FILENO, part, std::strlen(part)) < 0) return;
}

void onInterrupt(int) {
  if (interrupted.exchange(true)) {
    leaving = true;
    std::signal(SIGINT, SIG_DFL);
  } else if (const char* text = line; *text) {
    writeLine(text);
  }
}

void onTermination(int) { interrupted = leaving = true; }

}  // namespace

void catchInterrupts(const char* said) {
  line = said;
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onTermination);
}

}  // namespace chromeball
