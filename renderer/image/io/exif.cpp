// SPDX-License-Identifier: Apache-2.0
#include "image/io/exif.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "base/file.h"
#include "image/io/image_format.h"
#include "image/io/metadata_blocks.h"
#include "image/io/read_image.h"

namespace chromeball {
namespace {

enum Tag : uint16_t {
  kOrientation = 0x0112,
  kExposureTime = 0x829a,
  kFNumber = 0x829d,
  kExifDirectory = 0x8769,
  kPhotographicSensitivity = 0x8827,
  kFocalLengthIn35mmFilm = 0xa405
};

// IFD is a LONG that points to a directory; LONG8 and IFD8 are BigTIFF's.
enum Type : uint16_t { kShort = 3, kLong = 4, kRational = 5, kIfd = 13, kLong8 = 16, kIfd8 = 18 };

std::optional<double> positive(double number) {
  return number > 0 && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// TIFF 6.0 or BigTIFF. Bytes beyond the end read as 0.
class Block {
 public:
  explicit Block(std::span<const uint8_t> bytes)
      : bytes_(bytes), bigEndian_(!bytes.empty() && bytes[0] == 'M'), isBig_(number(2, 2) == 43) {}

  bool isTiff() const { return isBig_ || number(2, 2) == 42; }
  uint64_t firstDirectory() const { return isBig_ ? number(8, 8) : number(4, 4); }

  // The first value of the entry with this tag.
  std::optional<double> find(uint64_t directory, Tag tag) const {
    const uint64_t countBytes = isBig_ ? 8 : 2, entryBytes = isBig_ ? 20 : 12;
    const uint64_t count =
        std::min<uint64_t>(number(directory, countBytes), bytes_.size() / entryBytes);
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t entry = directory + countBytes + i * entryBytes;
      if (number(entry, 2) == tag) return value(entry);
    }
    return std::nullopt;
  }

 private:
  uint64_t number(uint64_t at, uint64_t count) const {
    if (count > bytes_.size() || at > bytes_.size() - count) return 0;
    uint64_t result = 0;
    for (uint64_t i = 0; i < count; ++i)
      result |= uint64_t(bytes_[at + i]) << 8 * (bigEndian_ ? count - 1 - i : i);
    return result;
  }

  std::optional<double> value(uint64_t entry) const {
    const uint64_t at = entry + (isBig_ ? 12 : 8);
    switch (number(entry + 2, 2)) {
      case kShort:
        return positive(double(number(at, 2)));
      case kLong:
      case kIfd:
        return positive(double(number(at, 4)));
      case kLong8:
      case kIfd8:
        return positive(double(number(at, 8)));
      case kRational: {
        const uint64_t rational = isBig_ ? at : number(at, 4);
        return positive(double(number(rational, 4)) / double(number(rational + 4, 4)));
      }
      default:
        return std::nullopt;
    }
  }

  std::span<const uint8_t> bytes_;
  bool bigEndian_, isBig_;
};

// Where the file has it; a TIFF is a block itself.
std::span<const uint8_t> blockOf(std::span<const uint8_t> file) {
  switch (imageFormat(file)) {
    case ImageFormat::Jpeg:
      return jpegExif(file);
    case ImageFormat::Png:
      return pngExif(file);
    case ImageFormat::Tiff:
      return file;
    default:
      return {};
  }
}

Exif parse(const Block& block) {
  constexpr double kMostBytes = 0x1p53;  // of a file, so that a double tells its positions
  if (!block.isTiff()) return {};
  const auto pointer = block.find(block.firstDirectory(), kExifDirectory);
  if (!pointer || *pointer > kMostBytes) return {};
  const auto find = [&](Tag tag) { return block.find(uint64_t(*pointer), tag); };
  return {find(kExposureTime), find(kFNumber), find(kPhotographicSensitivity),
          find(kFocalLengthIn35mmFilm)};
}

Exif fromAttributes(const Metadata& metadata) {
  const auto find = [&](const char* name) -> std::optional<double> {
    const auto found = metadata.find(name);
    if (found == metadata.end()) return std::nullopt;
    const auto* number = std::get_if<float>(&found->second);
    return number ? positive(*number) : std::nullopt;
  };
  return {find("expTime"), find("aperture"), find("isoSpeed"), {}};
}

}  // namespace

Exif readExif(const std::filesystem::path& path) {
  const FileBytes file(path);
  const std::span<const uint8_t> bytes = file.bytes();
  if (imageFormat(bytes) == ImageFormat::Exr) return fromAttributes(readExrMetadata(path));
  return parse(Block(blockOf(bytes)));
}

int exifOrientation(std::span<const uint8_t> file) {
  const Block block(blockOf(file));
  if (!block.isTiff()) return 1;
  const double stated = block.find(block.firstDirectory(), kOrientation).value_or(1);
  return stated <= 8 ? int(stated) : 1;
}

}  // namespace chromeball
