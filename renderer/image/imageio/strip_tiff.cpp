// SPDX-License-Identifier: Apache-2.0
// TIFF 6.0 and BigTIFF: a header with the offset of the first directory. A directory is a count,
// entries in the order of their tags, and the offset of the next directory.
#include "image/imageio/strip_tiff.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <stdexcept>

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

void put(std::span<uint8_t> to, uint64_t value, bool bigEndian) {
  for (size_t i = 0; i < to.size(); ++i)
    to[i] = uint8_t(value >> 8 * (bigEndian ? to.size() - 1 - i : i));
}

void append(std::vector<uint8_t>& bytes, uint64_t value, size_t count, bool bigEndian) {
  bytes.resize(bytes.size() + count);
  put(std::span(bytes).last(count), value, bigEndian);
}

struct FirstDirectory {
  bool bigEndian;
  size_t offsetBytes, countBytes, entryBytes;
  size_t at, first, count;  // the directory, its first entry, the number of its entries
};

// nullopt: the library rejects the file.
std::optional<FirstDirectory> firstDirectoryOf(std::span<const uint8_t> file) {
  if (file.size() < 16 || file[0] != file[1] || (file[0] != 'I' && file[0] != 'M')) return {};
  const bool bigEndian = file[0] == 'M';
  const bool isBig = number(file.subspan(2, 2), bigEndian) == 43;
  const size_t offsetBytes = isBig ? 8 : 4, countBytes = isBig ? 8 : 2,
               entryBytes = isBig ? 20 : 12;
  const uint64_t directory = number(file.subspan(offsetBytes, offsetBytes), bigEndian);
  if (directory > file.size() - countBytes) return {};
  const uint64_t count = number(file.subspan(directory, countBytes), bigEndian);
  const size_t first = directory + countBytes;
  if (count > (file.size() - first) / entryBytes) return {};
  return FirstDirectory{bigEndian, offsetBytes, countBytes, entryBytes, directory, first, count};
}

// Replaces all numbers of an entry of the directory by `change` of them. Of one that may become
// large the type becomes LONG.
template <class Change>
void changeNumbers(std::vector<uint8_t>& file, const FirstDirectory& directory, uint64_t tag,
                   const Change& change) {
  constexpr uint64_t kLong = 4;
  const auto at = [&](size_t place, size_t bytes) { return std::span(file).subspan(place, bytes); };
  const auto get = [&](size_t place, size_t bytes) {
    return number(at(place, bytes), directory.bigEndian);
  };
  for (size_t i = 0; i < directory.count; ++i) {
    const size_t entry = directory.first + i * directory.entryBytes;
    if (get(entry, 2) != tag) continue;
    const uint64_t type = get(entry + 2, 2), count = get(entry + 4, directory.offsetBytes);
    const size_t bytes = type == kShort ? 2 : 4, field = entry + 4 + directory.offsetBytes;
    if ((type != kShort && type != kLong) || count > file.size() / bytes)
      throw std::runtime_error("its directory is damaged");
    if (count == 1) {
      const uint64_t changed = change(get(field, bytes));
      put(at(entry + 2, 2), kLong, directory.bigEndian);
      put(at(field, 4), changed, directory.bigEndian);
      continue;
    }
    const size_t first =
        count * bytes <= directory.offsetBytes ? field : get(field, directory.offsetBytes);
    if (first > file.size() - count * bytes) throw std::runtime_error("its directory is damaged");
    for (size_t k = first; k < first + count * bytes; k += bytes)
      put(at(k, bytes), change(get(k, bytes)), directory.bigEndian);
  }
}

}  // namespace

std::vector<uint8_t> stripTiff(std::span<const uint8_t> file) {
  std::vector<uint8_t> stripped(file.begin(), file.end());
  const std::optional<FirstDirectory> found = firstDirectoryOf(file);
  if (!found) return stripped;
  const auto [bigEndian, offsetBytes, countBytes, entryBytes, directory, first, count] = *found;

  const auto entryOf = [&, first = first, entryBytes = entryBytes](size_t i) {
    return file.subspan(first + i * entryBytes, entryBytes);
  };
  const auto tagOf = [&, bigEndian = bigEndian](size_t i) {
    return number(entryOf(i).first(2), bigEndian);
  };
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
    put(std::span(stripped).subspan(offsetBytes, offsetBytes), at, bigEndian);
  }
  std::ranges::copy(kept, stripped.begin() + ptrdiff_t(at));
  return stripped;
}

BytesOfDoubles bytesOfDoubles(std::span<const uint8_t> file) {
  constexpr uint64_t kImageWidth = 256, kPhotometric = 262, kPredictor = 317, kTileWidth = 322,
                     kSampleFormat = 339, kMinIsBlack = 1, kNoPredictor = 1, kUnsigned = 1;
  const std::optional<FirstDirectory> directory = firstDirectoryOf(file);
  if (!directory) throw std::runtime_error("its directory is damaged");
  BytesOfDoubles result{{file.begin(), file.end()}, directory->bigEndian};
  const auto replace = [&](uint64_t tag, const auto& change) {
    changeNumbers(result.file, *directory, tag, change);
  };
  const auto asBytes = [](uint64_t width) {
    if (width > std::numeric_limits<int>::max() / sizeof(double))
      throw std::runtime_error("it is too wide for numbers of 64 bits");
    return width * sizeof(double);
  };
  replace(kImageWidth, asBytes);
  replace(kTileWidth, asBytes);
  replace(kBitsPerSample, [](uint64_t) { return uint64_t(8); });
  replace(kSampleFormat, [](uint64_t) { return kUnsigned; });
  // The library turns bytes whose 0 is white.
  replace(kPhotometric, [](uint64_t kind) { return kind == 0 ? kMinIsBlack : kind; });
  replace(kPredictor, [&](uint64_t predictor) {
    result.predictor = int(std::min<uint64_t>(predictor, 99));
    return kNoPredictor;
  });
  return result;
}

void decodeDoubles(const BytesOfDoubles& image, std::span<uint8_t> row, size_t samples,
                   std::vector<double>& numbers) {
  constexpr int kHorizontal = 2, kFloatingPoint = 3;
  constexpr size_t kBytes = sizeof(double);
  const size_t count = row.size() / kBytes;
  const bool isOfPlanes = image.predictor == kFloatingPoint;
  if (image.predictor > kFloatingPoint) throw std::runtime_error("its predictor is not known");
  if (isOfPlanes)
    for (size_t i = samples; i < row.size(); ++i) row[i] = uint8_t(row[i] + row[i - samples]);
  std::vector<uint64_t> words(count);
  for (size_t i = 0; i < count; ++i)
    for (size_t b = 0; b < kBytes; ++b)  // from the most significant byte on
      words[i] = words[i] << 8 | (isOfPlanes        ? row[b * count + i]
                                  : image.bigEndian ? row[i * kBytes + b]
                                                    : row[i * kBytes + kBytes - 1 - b]);
  if (image.predictor == kHorizontal)
    for (size_t i = samples; i < count; ++i) words[i] += words[i - samples];
  numbers.resize(count);
  for (size_t i = 0; i < count; ++i) numbers[i] = std::bit_cast<double>(words[i]);
}

}  // namespace chromeball
