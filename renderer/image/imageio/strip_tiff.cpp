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

void append(std::vector<uint8_t>& bytes, uint64_t value, size_t count, bool bigEndian) {
  for (size_t i = 0; i < count; ++i)
    bytes.push_back(uint8_t(value >> 8 * (bigEndian ? count - 1 - i : i)));
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
    std::vector<uint8_t> offset;
    append(offset, at, offsetBytes, bigEndian);
    std::ranges::copy(offset, stripped.begin() + ptrdiff_t(offsetBytes));
  }
  std::ranges::copy(kept, stripped.begin() + ptrdiff_t(at));
  return stripped;
}

namespace {

// Numbers of the first directory, in place.
class DirectoryNumbers {
 public:
  DirectoryNumbers(std::vector<uint8_t>& file, const FirstDirectory& directory)
      : file_(file), directory_(directory) {}

  // Replaces all numbers of the entry by `change` of them. Of one that may become large the type
  // becomes LONG.
  template <class Change>
  void change(uint64_t tag, const Change& change) {
    for (size_t i = 0; i < directory_.count; ++i) {
      const size_t entry = directory_.first + i * directory_.entryBytes;
      if (get(entry, 2) == tag) changeEntry(entry, change);
    }
  }

 private:
  template <class Change>
  void changeEntry(size_t entry, const Change& change) {
    constexpr uint64_t kLong = 4;
    const uint64_t type = get(entry + 2, 2), count = get(entry + 4, directory_.offsetBytes);
    const size_t bytes = type == kShort ? 2 : 4, field = entry + 4 + directory_.offsetBytes;
    if ((type != kShort && type != kLong) || count > file_.size() / bytes)
      throw std::runtime_error("its directory is damaged");
    if (count == 1) {
      const uint64_t changed = change(get(field, bytes));
      set(entry + 2, kLong, 2), set(field, changed, 4);
      return;
    }
    const size_t at =
        count * bytes <= directory_.offsetBytes ? field : get(field, directory_.offsetBytes);
    if (at > file_.size() - count * bytes) throw std::runtime_error("its directory is damaged");
    for (size_t i = 0; i < count; ++i)
      set(at + i * bytes, change(get(at + i * bytes, bytes)), bytes);
  }

  uint64_t get(size_t at, size_t bytes) const {
    return number(std::span(file_).subspan(at, bytes), directory_.bigEndian);
  }
  void set(size_t at, uint64_t value, size_t bytes) {
    std::vector<uint8_t> text;
    append(text, value, bytes, directory_.bigEndian);
    std::ranges::copy(text, file_.begin() + ptrdiff_t(at));
  }

  std::vector<uint8_t>& file_;
  FirstDirectory directory_;
};

}  // namespace

BytesOfDoubles bytesOfDoubles(std::span<const uint8_t> file) {
  constexpr uint64_t kImageWidth = 256, kPhotometric = 262, kPredictor = 317, kTileWidth = 322,
                     kSampleFormat = 339, kMinIsBlack = 1, kNoPredictor = 1, kUnsigned = 1;
  const std::optional<FirstDirectory> directory = firstDirectoryOf(file);
  if (!directory) throw std::runtime_error("its directory is damaged");
  BytesOfDoubles result{{file.begin(), file.end()}, directory->bigEndian};
  DirectoryNumbers numbers(result.file, *directory);
  const auto asBytes = [](uint64_t width) {
    if (width > std::numeric_limits<int>::max() / sizeof(double))
      throw std::runtime_error("it is too wide for numbers of 64 bits");
    return width * sizeof(double);
  };
  numbers.change(kImageWidth, asBytes);
  numbers.change(kTileWidth, asBytes);
  numbers.change(kBitsPerSample, [](uint64_t) { return uint64_t(8); });
  numbers.change(kSampleFormat, [](uint64_t) { return kUnsigned; });
  // The library turns bytes whose 0 is white.
  numbers.change(kPhotometric, [](uint64_t kind) { return kind == 0 ? kMinIsBlack : kind; });
  numbers.change(kPredictor, [&](uint64_t predictor) {
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
