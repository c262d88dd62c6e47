// SPDX-License-Identifier: Apache-2.0
// A setting that names something, and where it was given.
#pragma once

#include <string>

namespace chromeball {

// Only the code that uses the name (of a strategy, a camera of the model) can check it. `location`
// is "FILE:LINE" or an option of the command line; the error for an unknown name begins with it.
struct NamedSetting {
  std::string name;
  std::string location;
};

}  // namespace chromeball
