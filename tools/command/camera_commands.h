// SPDX-License-Identifier: Apache-2.0
// The subcommands of `chromeball camera`.
#pragma once

#include "command.h"

namespace chromeball {

void addCameraSolveCommand(Command camera);

}  // namespace chromeball
