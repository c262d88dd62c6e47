// SPDX-License-Identifier: Apache-2.0
#include "process.h"

#include <unistd.h>

#include <atomic>

#include "base/error.h"

namespace chromeball::python {

void checkProcess() {
  static std::atomic<pid_t> first = 0;  // the process that has started threads
  pid_t none = 0;
  if (!first.compare_exchange_strong(none, getpid()) && none != getpid())
    throwRun(
        "this process was forked after the renderer had started its threads, which it lacks; "
        "start it by `spawn` (multiprocessing.get_context(\"spawn\")), or before the first render");
}

}  // namespace chromeball::python
