// SPDX-License-Identifier: Apache-2.0
// State that this program reads again, behind the image of an .exr, where other programs do not
// look.
//
//   blocks    of Archive::blocks(), one after the other
//   head      the rest of the archive
//   table     of the blocks: length and checksum of each
//   footer    ExrStateFooter
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "base/archive.h"

namespace chromeball {

// A block in the byte order of the machine, which is little-endian (x86-64).
struct ExrStateBlock {
  uint64_t length, checksum;
};
struct ExrStateFooter {
  static constexpr std::array<char, 16> kMagic{'c', 'h', 'r', 'o', 'm', 'e', 'b', 'a',
                                               'l', 'l', ' ', 's', 't', 'a', 't', 'e'};
  uint64_t imageLength = 0, blocks = 0, headLength = 0;  // bytes, number, bytes
  uint64_t checksum = 0;                                 // of head and table
  std::array<char, 16> magic = kMagic;
};

// Appends the state to `file`, whose errors name `path`. Throws RunError.
void appendExrState(const std::filesystem::path& file, const std::filesystem::path& path,
                    const std::function<void(Archive&)>& state);

// Reads the state; `read` may leave out the blocks and the end. The head is checked before `read`
// is called, blocks when they are read. Throws InputError if there is none, or if it is damaged.
void readExrState(const std::filesystem::path& path, const std::function<void(Archive&)>& read);

}  // namespace chromeball
