// SPDX-License-Identifier: Apache-2.0
// A setting whose value is a name, with the location where the user gave it.
#pragma once

#include <string>

namespace chromeball {

// Only the code that uses the name (of a strategy or of a camera in the model) can check it.
// `location` is "FILE:LINE" or a command-line option; the error for an unknown name starts with it.
struct NamedSetting {
  std::string name;
  std::string location;
};

}  // namespace chromeball
