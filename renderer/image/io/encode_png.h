// SPDX-License-Identifier: Apache-2.0
// PNG in memory: for documents that carry their pictures with them, and for files, since
// OpenImageIO's writer does not notice a disk that is full.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// `bytes` are rows of interleaved 8-bit channels, sRGB: one (grey), three, or four with
// unassociated alpha, which come back unchanged.
std::vector<uint8_t> encodePng(int width, int height, int channels, std::span<const uint8_t> bytes);

}  // namespace chromeball
