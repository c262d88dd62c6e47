// SPDX-License-Identifier: Apache-2.0
// Option names of other renderers.
#pragma once

#include <string_view>

namespace chromeball {

// Our option for another renderer's ("--spp", "-s"): "--samples N". Empty if that is unknown.
std::string_view equivalentOption(std::string_view option);

}  // namespace chromeball
