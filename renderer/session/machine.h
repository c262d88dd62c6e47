// SPDX-License-Identifier: Apache-2.0
// The machine, the program and the date of a measurement.
#pragma once

#include <cstdint>
#include <string>

namespace chromeball {

struct Machine {
  std::string processor, system, compiler, date;  // date: UTC
  int threads = 0;                                // used by this run
  std::string command;                            // quoted for a shell
};
Machine thisMachine();

uint64_t peakMemoryBytes();  // of this process so far; 0 if the system does not tell

std::string commandLine();  // of this process, quoted for a shell

}  // namespace chromeball
