// SPDX-License-Identifier: Apache-2.0
// Option names of other renderers.
#pragma once

#include <string_view>

namespace chromeball {

// Our equivalent of another renderer's option: "--samples N" for "--spp" or "-s". Empty if unknown.
std::string_view equivalentOption(std::string_view option);

}  // namespace chromeball
