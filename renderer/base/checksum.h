// SPDX-License-Identifier: Apache-2.0
// A sum that tells damage to many bytes; as fast as memory, and no protection from intent.
#pragma once

#include <cstdint>
#include <span>

namespace chromeball {

// Any change of bytes within one aligned word of eight changes it.
uint64_t checksum(std::span<const char> bytes);

}  // namespace chromeball
