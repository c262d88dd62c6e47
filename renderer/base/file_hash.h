// SPDX-License-Identifier: Apache-2.0
// A hash of a file's contents.
#pragma once

#include <cstdint>
#include <string>

namespace chromeball {

// A hash of a file's bytes. Throws InputError if it cannot be read.
uint64_t fingerprint(const std::string& path);

}  // namespace chromeball
