// SPDX-License-Identifier: Apache-2.0
// What other renderers call our options.
#pragma once

#include <string_view>

namespace chromeball {

// How this program says what `option` ("--spp", "-s") says elsewhere: "--samples N". Empty where it
// is no name we know.
std::string_view ourOption(std::string_view option);

}  // namespace chromeball
