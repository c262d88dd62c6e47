// SPDX-License-Identifier: Apache-2.0
// The command line: runs the subcommand, and turns every error into one line and an exit status.
#pragma once

namespace chromeball {

// The arguments of main(); the first is the program's name. Returns the exit status.
int runCommandLine(int argc, char** argv);

}  // namespace chromeball
