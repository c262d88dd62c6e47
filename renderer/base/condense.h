// SPDX-License-Identifier: Apache-2.0
// Many messages of a kind as one.
#pragma once

#include "base/message.h"

namespace chromeball {

// For a terminal: of more than three messages that differ only in numbers and in quoted names, the
// first with a count of the others.
Messages condensed(const Messages& messages);

}  // namespace chromeball
