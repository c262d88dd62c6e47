// SPDX-License-Identifier: Apache-2.0
// Included before every file where GCC 12 compiles without precompiled headers: it then warns
// wrongly of code in {fmt} 9 and in its own std::string (GCC bugs 105651 and 105329). The warnings
// stay on for all other code.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wrestrict"
#pragma GCC diagnostic ignored "-Wstringop-overflow"
#include <fmt/format.h>

#include <string>
#pragma GCC diagnostic pop
