// SPDX-License-Identifier: Apache-2.0
// How large an image may be. A file that is too large is rejected by its header, before anything is
// allocated.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"

namespace chromeball {

inline constexpr uint64_t kMaxImageFloats = uint64_t(1) << 29;  // 2 GiB: 16k x 8k RGBA

// Upper bounds on what a file of a given length can hold, whatever its header claims. Deflate
// compresses at most 1032 : 1. In a JPEG each block of 64 texels takes a Huffman code of at least
// one bit.
inline constexpr uint64_t kMaxDeflateRatio = 1032, kMaxTexelsPerJpegByte = 8 * 64;

// Throws InputError unless all three are positive and their product is at most `maxNumbers`.
inline void checkImageSize(const std::filesystem::path& path, int64_t width, int64_t height,
                           int64_t channels, uint64_t maxNumbers = kMaxImageFloats) {
  if (width < 1 || height < 1 || channels < 1)
    throwInput("{}: the header claims {} x {} texels with {} channels; all must be positive",
               path.string(), width, height, channels);
  const uint64_t budget = maxNumbers / uint64_t(channels);
  if (uint64_t(width) > budget || uint64_t(height) > budget / uint64_t(width))
    throwInput("{}: {} x {} texels with {} channels exceed the limit of {} numbers per image",
               path.string(), width, height, channels, maxNumbers);
}

}  // namespace chromeball
