// SPDX-License-Identifier: Apache-2.0
// What is in a file, as a number.
#pragma once

#include <cstdint>
#include <string>

namespace chromeball {

// A hash of a file's bytes. Throws InputError where it cannot be read.
uint64_t fingerprint(const std::string& path);

}  // namespace chromeball
