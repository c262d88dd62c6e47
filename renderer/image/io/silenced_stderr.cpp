// SPDX-License-Identifier: Apache-2.0
#include "image/io/silenced_stderr.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

namespace chromeball {
namespace {

std::mutex mutex;
int living = 0;
int savedError = -1;

}  // namespace

QuietStandardError::QuietStandardError() {
  const std::lock_guard lock(mutex);
  if (living++ > 0) return;
  std::fflush(stderr);
  savedError = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (savedError >= 0 && nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  if (nowhere >= 0) close(nowhere);
}

QuietStandardError::~QuietStandardError() {
  const std::lock_guard lock(mutex);
  if (--living > 0 || savedError < 0) return;
  std::fflush(stderr);
  dup2(savedError, STDERR_FILENO);
  close(savedError);
}

}  // namespace chromeball
