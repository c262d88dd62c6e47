// SPDX-License-Identifier: Apache-2.0
// How large an image may be. A file that is too large is rejected by its header, before anything is
// allocated.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "base/memory.h"

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

// Throws InputError if a file of `fileBytes` cannot hold `bytes` of texels, each of its bytes at
// most `maxRatio`; small images may have any ratio.
inline void checkFileLength(const std::filesystem::path& path, int width, int height,
                            uint64_t bytes, uint64_t fileBytes, uint64_t maxRatio) {
  constexpr uint64_t kAlwaysAllowed = 64 << 20;
  if (bytes > std::max(kAlwaysAllowed, fileBytes * maxRatio))
    throwInput("{}: too short for {} x {} texels", path.string(), width, height);
}
// For a compression without a known bound: an estimate.
inline constexpr uint64_t kMaxUnknownRatio = 100'000;

// Throws InputError if an image with these numbers, of `bytes` each, and its copies do not fit into
// the memory that the process may use. For whole images that are read from a file or made for one,
// before they are allocated. `copies`: as read, as converted, and as written or prepared for
// look-ups. Small images are left to the allocator.
inline void checkImageMemory(const std::filesystem::path& path, int64_t width, int64_t height,
                             int64_t channels, size_t bytes = sizeof(float), double copies = 3) {
  constexpr double kAlwaysAllowed = 64 << 20;
  const double image = double(width) * double(height) * double(channels) * double(bytes);
  if (image <= kAlwaysAllowed || copies * image <= memoryBudget()) return;
  throwInput(
      "{}: {} x {} texels with {} channels take {:.3g} GB of memory in all; {:.3g} GB are allowed",
      path.string(), width, height, channels, 1e-9 * copies * image, 1e-9 * memoryBudget());
}

}  // namespace chromeball
