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
constexpr uint64_t kBitsPerSample = 258, kDefaultBits = 1, kShort = 3;

uint64_t number(std::span<const uint8_t> bytes, bool bigEndian) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes.size(); ++i)
    value |= uint64_t(bytes[i]) << 8 * (bigEndian ? bytes.size() - 1 - i : i);
  return value;
}

void append(std::vector<uint8_t>& bytes, uint64_t value, size_t count, bool bigEndian) {
  for (size_t i = 0; i < count; ++i)
    bytes.push_back(uint8_t(value >> 8 * (bigEndian ? count - 1 - i : i)));
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

  const auto entryOf = [&](size_t i) { return file.subspan(first + i * entryBytes, entryBytes); };
  const auto tagOf = [&](size_t i) { return number(entryOf(i).first(2), bigEndian); };
  bool statesBits = false;
  for (size_t i = 0; i < count; ++i) statesBits = statesBits || tagOf(i) == kBitsPerSample;
  std::vector<uint8_t> entries;
  for (size_t i = 0; i < count; ++i) {
    if (std::ranges::count(kMetadataTags, tagOf(i)) > 0) continue;
    if (!statesBits && tagOf(i) > kBitsPerSample) {  // entries ascend
      append(entries, kBitsPerSample, 2, bigEndian);
      append(entries, kShort, 2, bigEndian);
      append(entries, 1, offsetBytes, bigEndian);  // number, and its value
      append(entries, kDefaultBits, 2, bigEndian);
      append(entries, 0, offsetBytes - 2, bigEndian);
      statesBits = true;
    }
    entries.insert(entries.end(), entryOf(i).begin(), entryOf(i).end());
  }

  // Goes in place of the directory, or behind the image if it has become longer.
  const size_t end = first + count * entryBytes, next = std::min(offsetBytes, file.size() - end);
  std::vector<uint8_t> kept;
  append(kept, entries.size() / entryBytes, countBytes, bigEndian);
  kept.insert(kept.end(), entries.begin(), entries.end());
  kept.insert(kept.end(), file.begin() + ptrdiff_t(end), file.begin() + ptrdiff_t(end + next));
  size_t at = directory;
  if (entries.size() > count * entryBytes) {
    at = (file.size() + 1) / 2 * 2;
    stripped.resize(at + kept.size());
    std::vector<uint8_t> offset;
    append(offset, at, offsetBytes, bigEndian);
    std::ranges::copy(offset, stripped.begin() + ptrdiff_t(offsetBytes));
  }
  std::ranges::copy(kept, stripped.begin() + ptrdiff_t(at));
  return stripped;
}

}  // namespace chromeball
