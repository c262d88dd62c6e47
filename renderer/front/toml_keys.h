// SPDX-License-Identifier: Apache-2.0
// Bounds the nesting of dotted keys before TOML is parsed: toml++ bounds that of values only, and
// walks the tables that keys make recursively.
#pragma once

#include <string>
#include <string_view>

namespace chromeball {

// Throws InputError, begun by `path` and the line, for a key of more than 16 parts (`a.b.c` has 3),
// as a header or anywhere else. Text that is not valid TOML passes, or fails with a line.
void checkKeyDepth(std::string_view toml, const std::string& path);

}  // namespace chromeball
