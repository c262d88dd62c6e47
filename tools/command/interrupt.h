// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM, for commands that end cleanly.
#pragma once

#include <atomic>

namespace chromeball {

// Set when the command should end: by a signal from catchInterrupts() on, or by other code.
extern std::atomic<bool> interrupted;

void catchInterrupts();

}  // namespace chromeball
