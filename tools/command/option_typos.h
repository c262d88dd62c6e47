// SPDX-License-Identifier: Apache-2.0
// Option names of other renderers.
#pragma once

#include <string_view>

namespace chromeball {

// Our option for that of another renderer: "--samples N" for "--spp" or "-s". Empty if unknown.
std::string_view equivalentOption(std::string_view option);

}  // namespace chromeball
