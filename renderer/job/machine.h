// SPDX-License-Identifier: Apache-2.0
// On what, with what and when something was measured.
#pragma once

#include <string>

namespace chromeball {

struct Machine {
  std::string processor, system, compiler, date;  // date: UTC
  int threads = 0;                                // that this run uses
  std::string command;                            // as a shell would take it
};
Machine thisMachine();

std::string commandLine();  // of this process, as a shell would take it

}  // namespace chromeball
