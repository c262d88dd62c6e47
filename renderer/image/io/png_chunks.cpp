// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum.
#include <algorithm>

#include "image/io/metadata_blocks.h"

namespace chromeball {

std::span<const uint8_t> pngChunk(std::span<const uint8_t> file, std::string_view type) {
  constexpr size_t kSignatureBytes = 8, kHeadBytes = 8;  // length and type
  constexpr size_t kChecksumBytes = 4;
  for (size_t at = kSignatureBytes; at + kHeadBytes <= file.size();) {
    const uint8_t* head = &file[at];
    const uint64_t length = uint64_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    const size_t begin = at + kHeadBytes;
    if (length > file.size() - begin) return {};
    if (std::string_view(reinterpret_cast<const char*>(head + 4), 4) == type)
      return file.subspan(begin, size_t(length));
    at = begin + size_t(length) + kChecksumBytes;
  }
  return {};
}

// Some writers begin the block with the name that it has in a JPEG.
std::span<const uint8_t> pngExif(std::span<const uint8_t> file) {
  const std::span<const uint8_t> chunk = pngChunk(file, "eXIf");
  const bool isNamed = chunk.size() >= kExifName.size() &&
                       std::equal(kExifName.begin(), kExifName.end(), chunk.begin());
  return isNamed ? chunk.subspan(kExifName.size()) : chunk;
}

}  // namespace chromeball
