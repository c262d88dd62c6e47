// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace chromeball {

std::string tbbVersion();  // of the library that runs, "2021.8.0"

}  // namespace chromeball
