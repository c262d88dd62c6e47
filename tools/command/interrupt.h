// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM, for commands that end cleanly.
#pragma once

#include <atomic>

namespace chromeball {

// Set when the command should end: by a signal from catchInterrupts() on, or by other code.
extern std::atomic<bool> interrupted;
// Set when it should not even denoise what there is: by a second Ctrl-C, or by SIGTERM, since what
// sends that soon kills. A third Ctrl-C kills.
extern std::atomic<bool> leaving;

// `said`: a line to print at the first Ctrl-C; must live until the end of the process.
void catchInterrupts(const char* said = "");

}  // namespace chromeball
