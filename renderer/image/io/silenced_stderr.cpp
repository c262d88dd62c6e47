// SPDX-License-Identifier: Apache-2.0
#include "image/io/silenced_stderr.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace chromeball {
namespace {

std::mutex mutex;
int objectCount = 0;
int savedError = -1;

}  // namespace

SilencedStderr::SilencedStderr() {
  const std::lock_guard lock(mutex);
  if (objectCount++ > 0) return;
  std::fflush(stderr);
  savedError = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int devNull = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (savedError >= 0 && devNull >= 0) dup2(devNull, STDERR_FILENO);
  if (devNull >= 0) close(devNull);
}

SilencedStderr::~SilencedStderr() {
  const std::lock_guard lock(mutex);
  if (--objectCount > 0 || savedError < 0) return;
  std::fflush(stderr);
  dup2(savedError, STDERR_FILENO);
  close(savedError);
}

}  // namespace chromeball
