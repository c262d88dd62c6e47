// PNG in memory, for documents that carry their pictures with them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace chromeball {

// `bytes` are rows of interleaved 8-bit channels, one (grey) or three, which come back unchanged.
std::vector<uint8_t> encodePng(int width, int height, int channels, std::span<const uint8_t> bytes);

}  // namespace chromeball
