// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"

namespace chromeball {

void throwFormattedInput(fmt::string_view format, fmt::format_args arguments) {
  throw InputError(fmt::vformat(format, arguments));
}

void throwFormattedRun(fmt::string_view format, fmt::format_args arguments) {
  throw RunError(fmt::vformat(format, arguments));
}

}  // namespace chromeball
