// SPDX-License-Identifier: Apache-2.0
#include "image/io/tiff.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace chromeball {
namespace {

// IFD is a LONG that points to a directory; LONG8 and IFD8 are BigTIFF's.
enum TiffType : uint16_t {
  kByte = 1,
  kShort = 3,
  kLong = 4,
  kRational = 5,
  kUndefined = 7,
  kIfd = 13,
  kLong8 = 16,
  kIfd8 = 18
};

// The size of an unsigned integer type; 0 for another type.
uint64_t integerBytes(uint64_t type) {
  if (type == kShort) return 2;
  if (type == kLong || type == kIfd) return 4;
  return type == kLong8 || type == kIfd8 ? 8 : 0;
}

class Inflater {
 public:
  Inflater() {
    if (inflateInit(&stream_) != Z_OK) throw std::runtime_error("zlib does not start");
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;

  // Whether the block is undamaged, as far as `budget` allows, a number of bytes that is reduced by
  // the inflated size.
  bool isSound(std::span<const uint8_t> block, double& budget) {
    inflateReset(&stream_);
    stream_.next_in = const_cast<uint8_t*>(block.data());
    stream_.avail_in = uInt(block.size());
    int state = Z_OK;
    while (state == Z_OK && budget > 0) {
      stream_.next_out = inflated_.data();
      stream_.avail_out = uInt(inflated_.size());
      state = inflate(&stream_, Z_NO_FLUSH);
      budget -= double(inflated_.size() - stream_.avail_out);
    }
    return state != Z_DATA_ERROR && state != Z_NEED_DICT;
  }

 private:
  z_stream stream_{};
  std::array<uint8_t, 1 << 15> inflated_;
};

}  // namespace

uint64_t TiffBlock::number(uint64_t at, uint64_t count) const {
  if (count > bytes_.size() || at > bytes_.size() - count) return 0;
  uint64_t result = 0;
  for (uint64_t i = 0; i < count; ++i)
    result |= uint64_t(bytes_[at + i]) << 8 * (bigEndian_ ? count - 1 - i : i);
  return result;
}

// The number of entries, no more than the file can have.
uint64_t TiffBlock::entriesOf(uint64_t directory) const {
  return std::min<uint64_t>(number(directory, countBytes()), bytes_.size() / entryBytes());
}

std::optional<uint64_t> TiffBlock::entryOf(uint64_t directory, uint16_t tag) const {
  const uint64_t count = entriesOf(directory);
  for (uint64_t i = 0; i < count; ++i) {
    const uint64_t entry = directory + countBytes() + i * entryBytes();
    if (number(entry, 2) == tag) return entry;
  }
  return std::nullopt;
}

uint64_t TiffBlock::nextDirectory(uint64_t directory) const {
  return number(directory + countBytes() + entriesOf(directory) * entryBytes(), offsetBytes());
}

std::optional<double> TiffBlock::find(uint64_t directory, uint16_t tag) const {
  const std::vector<double> ratios = rationals(directory, tag);
  const std::vector<uint64_t> whole = integers(directory, tag);
  const double first = !ratios.empty()  ? ratios.front()
                       : !whole.empty() ? double(whole.front())
                                        : 0;
  return first > 0 && std::isfinite(first) ? std::optional(first) : std::nullopt;
}

// The values are in the entry if they fit into it.
TiffBlock::Values TiffBlock::valuesOf(uint64_t entry, uint64_t bytesOfEach) const {
  const uint64_t count = number(entry + 4, offsetBytes()), field = entry + 4 + offsetBytes();
  const uint64_t most = std::min(count, bytes_.size() / bytesOfEach);
  return {count, most, bytesOfEach * most <= offsetBytes() ? field : number(field, offsetBytes())};
}

std::vector<double> TiffBlock::rationals(uint64_t directory, uint16_t tag) const {
  constexpr uint64_t kBytes = 8;
  const std::optional<uint64_t> entry = entryOf(directory, tag);
  if (!entry || number(*entry + 2, 2) != kRational) return {};
  const auto [count, most, at] = valuesOf(*entry, kBytes);
  std::vector<double> values;
  for (uint64_t i = 0; i < most; ++i)
    values.push_back(double(number(at + i * kBytes, 4)) / double(number(at + i * kBytes + 4, 4)));
  return values;
}

std::vector<uint64_t> TiffBlock::integers(uint64_t directory, uint16_t tag, uint64_t limit) const {
  const std::optional<uint64_t> entry = entryOf(directory, tag);
  const uint64_t bytes = entry ? integerBytes(number(*entry + 2, 2)) : 0;
  if (bytes == 0) return {};
  const auto [count, most, at] = valuesOf(*entry, bytes);
  std::vector<uint64_t> values;
  for (uint64_t i = 0; i < std::min(most, limit); ++i)
    values.push_back(number(at + i * bytes, bytes));
  return values;
}

std::span<const uint8_t> TiffBlock::bytes(uint64_t directory, uint16_t tag) const {
  const std::optional<uint64_t> entry = entryOf(directory, tag);
  const uint64_t type = entry ? number(*entry + 2, 2) : 0;
  if (type != kByte && type != kUndefined) return {};
  const auto [count, most, at] = valuesOf(*entry, 1);
  if (at > bytes_.size() || count > bytes_.size() - at) return {};
  return bytes_.subspan(at, count);
}

std::vector<uint8_t> TiffBlock::changed(uint64_t at, uint64_t count, uint64_t value) const {
  std::vector<uint8_t> bytes(bytes_.begin(), bytes_.end());
  for (uint64_t i = 0; i < count && at + i < bytes.size(); ++i)
    bytes[at + i] = uint8_t(value >> 8 * (bigEndian_ ? count - 1 - i : i));
  return bytes;
}

std::vector<uint8_t> TiffBlock::withFirstDirectory(uint64_t directory) const {
  return changed(firstDirectoryAt(), offsetBytes(), directory);
}

// A single value is in its entry.
std::vector<uint8_t> TiffBlock::withInteger(uint64_t directory, uint16_t tag,
                                            uint64_t value) const {
  const uint64_t entry = entryOf(directory, tag).value();
  return changed(entry + 4 + offsetBytes(), integerBytes(number(entry + 2, 2)), value);
}

void checkDeflate(std::span<const uint8_t> file) {
  const TiffBlock tiff(file);
  const uint64_t image = tiff.firstDirectory();
  const auto number = [&](uint16_t tag) { return tiff.find(image, tag).value_or(1); };
  constexpr uint16_t kWidth = 256, kHeight = 257, kBits = 258, kCompression = 259, kFillOrder = 266,
                     kSamples = 277;
  constexpr double kAdobeDeflate = 8, kDeflate = 32946;
  if (number(kCompression) != kAdobeDeflate && number(kCompression) != kDeflate) return;
  if (number(kFillOrder) == 2)  // the module would decode it to black
    throw std::runtime_error(
        "the bits of its bytes are in reversed order (FillOrder 2) under Deflate, "
        "which is not supported");
  // Tiles reach beyond the image, small ones less than a small image's.
  constexpr double kAlwaysAllowed = 64 << 20, kTilesOfImage = 4;
  double outBudget = kAlwaysAllowed + kTilesOfImage * number(kWidth) * number(kHeight) *
                                          number(kSamples) * number(kBits) / 8;
  uint64_t inBudget = file.size();
  Inflater inflater;
  for (const auto& [offsetTag, lengthTag] : {std::pair(273, 279), {324, 325}}) {  // strips, tiles
    const std::vector<uint64_t> offsets = tiff.integers(image, uint16_t(offsetTag)),
                                lengths = tiff.integers(image, uint16_t(lengthTag));
    std::set<uint64_t> seen;  // blocks may be shared
    for (size_t i = 0; i < std::min(offsets.size(), lengths.size()); ++i) {
      const uint64_t offset = offsets[i], length = lengths[i];
      if (offset > file.size() || length > file.size() - offset || !seen.insert(offset).second)
        continue;
      if (length > inBudget) return;
      inBudget -= length;
      if (!inflater.isSound(file.subspan(offset, length), outBudget))
        throw std::runtime_error(fmt::format(
            "block {} of its texels is damaged: Deflate's checksum or code is wrong", i + 1));
    }
  }
}

}  // namespace chromeball
