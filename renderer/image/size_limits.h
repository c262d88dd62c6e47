// SPDX-License-Identifier: Apache-2.0
// How large an image may be. Files are refused by their headers, before anything is allocated.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"

namespace chromeball {

inline constexpr uint64_t kMaxImageFloats = uint64_t(1) << 29;  // 2 GiB: 16k x 8k RGBA

// The most that a file can hold, whatever its header says: Deflate shrinks at most 1032 times, and
// in a JPEG each block of 64 texels has a Huffman code of at least a bit.
inline constexpr uint64_t kMaxDeflated = 1032, kMaxTexelsPerJpegByte = 8 * 64;

// Throws InputError unless all three are positive and their product is within the budget.
inline void checkImageSize(const std::filesystem::path& path, int64_t width, int64_t height,
                           int64_t channels) {
  if (width < 1 || height < 1 || channels < 1)
    throwInput("{}: the header says {} x {} texels of {} channels", path.string(), width, height,
               channels);
  const uint64_t budget = kMaxImageFloats / uint64_t(channels);
  if (uint64_t(width) > budget || uint64_t(height) > budget / uint64_t(width))
    throwInput("{}: {} x {} texels of {} channels is more than the {} numbers an image may hold",
               path.string(), width, height, channels, kMaxImageFloats);
}

}  // namespace chromeball
