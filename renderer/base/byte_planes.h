// SPDX-License-Identifier: Apache-2.0
// Lists of structures of numbers with few bytes that differ: the counts and weights of pixels, the
// low bytes of sums of few samples. Packing them is as fast as a disk.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace chromeball {

// Appends to `packed`, for each byte of an item, a flag and that byte of all items, or of one if
// all are equal. `items`: `count` of `size` bytes.
void packPlanes(const char* items, size_t count, size_t size, std::vector<char>& packed);

// Fills `items` from the first bytes of `packed`; returns how many these are, nullopt if they do
// not hold such a list.
std::optional<size_t> unpackPlanes(std::span<const char> packed, size_t count, size_t size,
                                   char* items);

}  // namespace chromeball
