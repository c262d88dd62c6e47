// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum. A lower-case
// first letter of the type marks ancillary chunks, which a decoder may ignore.
#include <algorithm>
#include <string_view>

#include "image/io/strip_metadata.h"

namespace chromeball {
namespace {

constexpr size_t kSignatureBytes = 8, kHeadBytes = 8;  // length and type
constexpr size_t kChunkOverhead = 12;                  // bytes of length, type and checksum

struct Chunk {
  std::string_view type;
  std::span<const uint8_t> bytes;  // all of it, to the end of the file if that comes first
};

// Calls visit(chunk) for all chunks.
template <class Visit>
void forChunks(std::span<const uint8_t> file, const Visit& visit) {
  for (size_t at = kSignatureBytes; at + kHeadBytes <= file.size();) {
    const uint8_t* head = &file[at];
    const uint64_t length = uint64_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    const size_t bytes = size_t(std::min<uint64_t>(length + kChunkOverhead, file.size() - at));
    visit(Chunk{{reinterpret_cast<const char*>(head + 4), 4}, file.subspan(at, bytes)});
    at += bytes;
  }
}

}  // namespace

HeaderSize pngSize(std::span<const uint8_t> file) {  // the first chunk, IHDR, begins with them
  constexpr size_t kWidthAt = 16, kEnd = 24;
  if (file.size() < kEnd) return {};
  const auto number = [&](size_t at) {
    return int(uint32_t(file[at]) << 24 | file[at + 1] << 16 | file[at + 2] << 8 | file[at + 3]);
  };
  const HeaderSize size{number(kWidthAt), number(kWidthAt + 4)};
  return size.width > 0 && size.height > 0 ? size : HeaderSize{};
}

std::span<const uint8_t> pngExif(std::span<const uint8_t> file) {
  std::span<const uint8_t> block;
  forChunks(file, [&](const Chunk& chunk) {
    if (chunk.type == "eXIf" && chunk.bytes.size() > kChunkOverhead)
      block = chunk.bytes.subspan(kHeadBytes, chunk.bytes.size() - kChunkOverhead);
  });
  return block;
}

std::vector<uint8_t> stripPng(std::span<const uint8_t> file) {
  std::vector<uint8_t> stripped(
      file.begin(), file.begin() + std::ptrdiff_t(std::min(kSignatureBytes, file.size())));
  forChunks(file, [&](const Chunk& chunk) {
    const bool ancillary = chunk.type[0] & 0x20;
    if (!ancillary || chunk.type == "tRNS")
      stripped.insert(stripped.end(), chunk.bytes.begin(), chunk.bytes.end());
  });
  return stripped;
}

}  // namespace chromeball
