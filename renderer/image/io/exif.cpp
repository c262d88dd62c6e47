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
#include "image/io/tiff_block.h"

namespace chromeball {
namespace {

enum Tag : uint16_t {
  kOrientation = 0x0112,
  kExposureTime = 0x829a,
  kFNumber = 0x829d,
  kExifDirectory = 0x8769,
  kPhotographicSensitivity = 0x8827,
  kStandardOutputSensitivity = 0x8831,
  kRecommendedExposureIndex = 0x8832,
  kIsoSpeed = 0x8833,
  kColorSpace = 0xa001,
  kFocalLengthIn35mmFilm = 0xa405
};

std::optional<double> positive(double number) {
  return number > 0 && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// The block where the file has it; a TIFF is a block itself.
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

// Looks a tag up in the directory of EXIF.
std::optional<double> findExif(const TiffBlock& block, Tag tag) {
  constexpr double kMostBytes = 0x1p53;  // of a file, so that a double tells its positions
  if (!block.isTiff()) return {};
  const auto pointer = block.find(block.firstDirectory(), kExifDirectory);
  if (!pointer || *pointer > kMostBytes) return {};
  return block.find(uint64_t(*pointer), tag);
}

// PhotographicSensitivity has 16 bits; its largest number refers to the other tags (EXIF 2.3,
// table 8).
std::optional<double> sensitivityOf(const TiffBlock& block) {
  constexpr double kOrHigher = 65535;
  const std::optional<double> stated = findExif(block, kPhotographicSensitivity);
  if (stated && *stated < kOrHigher) return stated;
  for (const Tag tag : {kIsoSpeed, kRecommendedExposureIndex, kStandardOutputSensitivity})
    if (const std::optional<double> found = findExif(block, tag)) return found;
  return stated;
}

Exif parse(const TiffBlock& block) {
  const auto find = [&](Tag tag) { return findExif(block, tag); };
  return {find(kExposureTime), find(kFNumber), sensitivityOf(block), find(kFocalLengthIn35mmFilm)};
}

Exif fromAttributes(const Metadata& metadata) {
  const auto find = [&](const char* name) -> std::optional<double> {
    const std::optional<double> number = metadataNumber(metadata, name);
    return number ? positive(*number) : std::nullopt;
  };
  return {find("expTime"), find("aperture"), find("isoSpeed"), {}};
}

}  // namespace

Exif readExif(const std::filesystem::path& path) {
  const FileBytes file(path);
  const std::span<const uint8_t> bytes = file.bytes();
  if (imageFormat(bytes) == ImageFormat::Exr) return fromAttributes(readExrMetadata(path));
  return parse(TiffBlock(blockOf(bytes)));
}

int exifOrientation(std::span<const uint8_t> file) {
  const TiffBlock block(blockOf(file));
  if (!block.isTiff()) return 1;
  const double stated = block.find(block.firstDirectory(), kOrientation).value_or(1);
  return stated <= 8 ? int(stated) : 1;
}

bool exifStatesOtherColors(std::span<const uint8_t> file) {
  constexpr double kSrgb = 1;  // others: 65535, uncalibrated; 2, Adobe RGB in older files
  return findExif(TiffBlock(blockOf(file)), kColorSpace).value_or(kSrgb) != kSrgb;
}

}  // namespace chromeball
