// SPDX-License-Identifier: Apache-2.0
// TIFF 6.0 and BigTIFF: a header with the offset of the first directory. A directory is a count,
// entries in the order of their tags, and the offset of the next directory.
#include <algorithm>
#include <array>

#include "image/imageio/strip_tiff.h"

namespace chromeball {
namespace {

// XMP, IPTC, Photoshop, EXIF, ICC, GPS, interoperability; orientation.
constexpr std::array<uint64_t, 8> kMetadataTags = {700,   33723, 34377, 34665,
                                                   34675, 34853, 40965, 274};

uint64_t number(std::span<const uint8_t> bytes, bool bigEndian) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i)
    value |= uint64_t(bytes[i]) << 8 * (bigEndian ? bytes.size() - 1 - i : i);
  return value;
}

}  // namespace

std::vector<uint8_t> stripTiff(std::span<const uint8_t> file) {
  std::vector<uint8_t> stripped(file.begin(), file.end());
  if (file.size() < 16 || file[0] != file[1] || (file[0] != 'I' && file[0] != 'M')) return stripped;
  const bool bigEndian = file[0] == 'M';
  const bool isBig = number(file.subspan(2, 2), bigEndian) == 43;
  const size_t offsetBytes = isBig ? 8 : 4, countBytes = isBig ? 8 : 2,
               entryBytes = isBig ? 20 : 12;
  const uint64_t directory = number(file.subspan(offsetBytes, offsetBytes), bigEndian);
  if (directory > file.size() - countBytes) return stripped;
  const uint64_t count = number(file.subspan(directory, countBytes), bigEndian);
  const size_t first = directory + countBytes;
  if (count > (file.size() - first) / entryBytes) return stripped;  // the library rejects it

  // Close the gaps between the kept entries, and move the offset of the next directory after them.
  size_t to = first;
  uint64_t kept = 0;
  const size_t end = first + count * entryBytes;
  for (size_t from = first; from < end; from += entryBytes) {
    const uint64_t tag = number(file.subspan(from, 2), bigEndian);
    if (std::find(kMetadataTags.begin(), kMetadataTags.end(), tag) != kMetadataTags.end()) continue;
    std::copy_n(file.begin() + std::ptrdiff_t(from), entryBytes,
                stripped.begin() + std::ptrdiff_t(to));
    to += entryBytes;
    ++kept;
  }
  const size_t next = std::min(offsetBytes, file.size() - end);
  std::copy_n(file.begin() + std::ptrdiff_t(end), next, stripped.begin() + std::ptrdiff_t(to));
  for (size_t i = 0; i < countBytes; ++i)
    stripped[directory + i] = uint8_t(kept >> 8 * (bigEndian ? countBytes - 1 - i : i));
  return stripped;
}

}  // namespace chromeball
