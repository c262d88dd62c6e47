// SPDX-License-Identifier: Apache-2.0
// Encodes a PNG in memory: for images embedded in documents, and for files.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// `bytes` are rows of interleaved 8-bit sRGB channels: one (grey), three, or four with unassociated
// alpha. The encoding is lossless.
std::vector<uint8_t> encodePng(int width, int height, int channels, std::span<const uint8_t> bytes);

}  // namespace chromeball
