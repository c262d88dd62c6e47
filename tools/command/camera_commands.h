// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball camera`.
#pragma once

#include <CLI/CLI.hpp>

namespace chromeball {

void addCameraSolveCommand(CLI::App& camera);

}  // namespace chromeball
