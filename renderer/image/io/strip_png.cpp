// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum. A lower-case
// first letter of the type marks ancillary chunks, which a decoder may ignore.
#include <algorithm>
#include <string_view>

#include "image/io/strip_metadata.h"

namespace chromeball {

std::vector<uint8_t> stripPng(std::span<const uint8_t> file) {
  constexpr size_t kSignatureBytes = 8;
  constexpr size_t kChunkOverhead = 12;  // bytes of length, type and checksum
  std::vector<uint8_t> stripped(
      file.begin(), file.begin() + std::ptrdiff_t(std::min(kSignatureBytes, file.size())));
  for (size_t at = stripped.size(); at + 8 <= file.size();) {
    const uint8_t* chunk = &file[at];
    const uint64_t length = uint64_t(chunk[0]) << 24 | chunk[1] << 16 | chunk[2] << 8 | chunk[3];
    const std::string_view type(reinterpret_cast<const char*>(chunk + 4), 4);
    const size_t bytes = size_t(std::min<uint64_t>(length + kChunkOverhead, file.size() - at));
    const bool ancillary = type[0] & 0x20;
    if (!ancillary || type == "tRNS") stripped.insert(stripped.end(), chunk, chunk + bytes);
    at += bytes;
  }
  return stripped;
}

}  // namespace chromeball
