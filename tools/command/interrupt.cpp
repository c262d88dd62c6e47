// SPDX-License-Identifier: Apache-2.0
#include "interrupt.h"

#include <csignal>

namespace chromeball {

std::atomic<bool> interrupted = false;

void catchInterrupts() {
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
}

}  // namespace chromeball
