// SPDX-License-Identifier: Apache-2.0
// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum. A small first
// letter marks the chunks that a decoder may ignore.
#include <algorithm>
#include <string_view>

#include "image/io/strip_metadata.h"

namespace chromeball {

std::vector<uint8_t> barePng(std::span<const uint8_t> file) {
  constexpr size_t kSignature = 8, kAround = 12;  // bytes of a chunk beside its data
  std::vector<uint8_t> bare(file.begin(),
                            file.begin() + std::ptrdiff_t(std::min(kSignature, file.size())));
  for (size_t at = bare.size(); at + 8 <= file.size();) {
    const uint8_t* chunk = &file[at];
    const uint64_t length = uint64_t(chunk[0]) << 24 | chunk[1] << 16 | chunk[2] << 8 | chunk[3];
    const std::string_view type(reinterpret_cast<const char*>(chunk + 4), 4);
    const size_t whole = size_t(std::min<uint64_t>(length + kAround, file.size() - at));
    const bool ancillary = type[0] & 0x20;
    if (!ancillary || type == "tRNS") bare.insert(bare.end(), chunk, chunk + whole);
    at += whole;
  }
  return bare;
}

}  // namespace chromeball
