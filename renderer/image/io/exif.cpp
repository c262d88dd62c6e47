// SPDX-License-Identifier: Apache-2.0
#include "image/io/exif.h"

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
  kExposureTime = 0x829a,
  kFNumber = 0x829d,
  kExifDirectory = 0x8769,
  kPhotographicSensitivity = 0x8827,
  kFocalLengthIn35mmFilm = 0xa405
};

enum Type : uint16_t { kShort = 3, kLong = 4, kRational = 5 };

std::optional<double> positive(double number) {
  return number > 0 && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// Bytes beyond the end read as 0.
class Block {
 public:
  explicit Block(std::span<const uint8_t> bytes)
      : bytes_(bytes), bigEndian_(!bytes.empty() && bytes[0] == 'M') {}

  bool isTiff() const { return number(2, 2) == 42; }
  uint64_t firstDirectory() const { return number(4, 4); }

  // The first value of the entry with this tag.
  std::optional<double> find(uint64_t directory, Tag tag) const {
    constexpr uint64_t kEntryBytes = 12;
    const uint64_t count = number(directory, 2);
    for (uint64_t i = 0; i < count; ++i) {
      const uint64_t entry = directory + 2 + i * kEntryBytes;
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
    const uint64_t at = entry + 8;
    switch (number(entry + 2, 2)) {
      case kShort:
        return positive(double(number(at, 2)));
      case kLong:
        return positive(double(uint32_t(number(at, 4))));
      case kRational: {
        const uint64_t rational = number(at, 4);
        return positive(double(number(rational, 4)) / double(number(rational + 4, 4)));
      }
      default:
        return std::nullopt;
    }
  }

  std::span<const uint8_t> bytes_;
  bool bigEndian_;
};

Exif parse(const Block& block) {
  if (!block.isTiff()) return {};
  const auto pointer = block.find(block.firstDirectory(), kExifDirectory);
  if (!pointer) return {};
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
  switch (imageFormat(bytes)) {
    case ImageFormat::Exr:
      return fromAttributes(readExrMetadata(path));
    case ImageFormat::Jpeg:
      return parse(Block(jpegExif(bytes)));
    case ImageFormat::Png:
      return parse(Block(pngExif(bytes)));
    case ImageFormat::Tiff:
      return parse(Block(bytes));
    default:
      return {};
  }
}

}  // namespace chromeball
