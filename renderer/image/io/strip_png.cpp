// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum. A lower-case
// first letter of the type marks ancillary chunks, which a decoder may ignore.
#include <algorithm>
#include <string_view>

#include "image/io/strip_metadata.h"

namespace chromeball {

HeaderSize pngSize(std::span<const uint8_t> file) {  // the first chunk, IHDR, begins with them
  constexpr size_t kWidthAt = 16, kEnd = 24;
  if (file.size() < kEnd) return {};
  const auto number = [&](size_t at) {
    return int(uint32_t(file[at]) << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3]);
  };
  const HeaderSize size{number(kWidthAt), number(kWidthAt + 4)};
  return size.width > 0 && size.height > 0 ? size : HeaderSize{};
}

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
