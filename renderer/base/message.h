// SPDX-License-Identifier: Apache-2.0
// Messages of the library to its user. The library itself prints nothing.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/remedy.h"

namespace chromeball {

struct Message {
  enum class Kind {
    Note,     // what was detected or chosen
    Warning,  // what may spoil the image
  };
  Kind kind;
  std::string text;  // one line, without a full stop
  std::optional<Remedy> remedy = {};
};

using Messages = std::vector<Message>;

}  // namespace chromeball
