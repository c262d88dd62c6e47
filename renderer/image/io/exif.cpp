// SPDX-License-Identifier: Apache-2.0
#include "image/io/exif.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "image/io/image_format.h"
#include "image/io/read_image.h"
#include "image/io/tiff.h"

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

// JPEG (ITU-T T.81, annex B): markers, most of them followed by a segment of a stated length, up to
// the first start of scan.
enum JpegMarker : uint8_t {
  kTem = 0x01,
  kRst0 = 0xd0,
  kSoi = 0xd8,
  kEoi = 0xd9,
  kSos = 0xda,
  kApp0 = 0xe0,  // JFIF
  kApp1 = 0xe1,  // EXIF, XMP
  kApp2 = 0xe2   // an ICC profile
};

bool standsAlone(uint8_t marker) { return marker == kTem || (marker >= kRst0 && marker <= kSoi); }

// The second byte of the next marker; 0 at the end of the file. Skips anything between segments, as
// libjpeg does, and moves `at` to the byte after the marker.
uint8_t nextMarker(std::span<const uint8_t> file, size_t& at) {
  for (; at + 1 < file.size(); ++at)
    if (file[at] == 0xff && file[at + 1] != 0xff && file[at + 1] != 0) {
      at += 2;
      return file[at - 1];
    }
  return 0;
}

// The end of the segment whose marker ends at `at`.
size_t endOfSegment(std::span<const uint8_t> file, size_t at, uint8_t marker) {
  if (standsAlone(marker)) return at;
  if (file.size() - at < 2) return file.size();
  return std::min(at + size_t(std::max(file[at] << 8 | file[at + 1], 2)), file.size());
}

// The data of each segment with this marker that begins with `name`, after it.
std::vector<std::span<const uint8_t>> segmentsOf(std::span<const uint8_t> file, uint8_t wanted,
                                                 std::string_view name) {
  constexpr size_t kLengthBytes = 2;
  const size_t dataAt = kLengthBytes + name.size();
  std::vector<std::span<const uint8_t>> found;
  size_t at = 0;
  while (const uint8_t marker = nextMarker(file, at)) {
    if (marker == kSos || marker == kEoi) break;
    const size_t begin = at;
    at = endOfSegment(file, at, marker);
    const std::span<const uint8_t> segment = file.subspan(begin, at - begin);
    if (marker == wanted && segment.size() > dataAt &&
        textOf(segment.subspan(kLengthBytes)).starts_with(name))
      found.push_back(segment.subspan(dataAt));
  }
  return found;
}

// The data of the first of them; empty if there is none.
std::span<const uint8_t> segmentOf(std::span<const uint8_t> file, uint8_t wanted,
                                   std::string_view name) {
  const auto found = segmentsOf(file, wanted, name);
  return found.empty() ? std::span<const uint8_t>() : found.front();
}

// Comes before the EXIF block in its segment of a JPEG; some writers begin that of a PNG with it.
constexpr std::string_view kExifName("Exif\0\0", 6);

// The block where the file has it; a TIFF is a block itself.
std::span<const uint8_t> blockOf(std::span<const uint8_t> file) {
  switch (imageFormat(file)) {
    case ImageFormat::Jpeg:
      return segmentOf(file, kApp1, kExifName);
    case ImageFormat::Png: {
      const std::span<const uint8_t> chunk = pngChunk(file, "eXIf");
      return chunk.subspan(textOf(chunk).starts_with(kExifName) ? kExifName.size() : 0);
    }
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

Exif fromAttributes(const Metadata& metadata) {
  const auto find = [&](const char* name) {
    const std::optional<double> number = metadataNumber(metadata, name);
    return number && *number > 0 && std::isfinite(*number) ? number : std::nullopt;
  };
  return {find("expTime"), find("aperture"), find("isoSpeed"), {}};
}

// The ratio of two numbers of `size` bytes, the width's first.
double ratioIn(std::span<const uint8_t> data, size_t at, size_t size) {
  if (data.size() < at + 2 * size) return 1;
  return double(bigEndian(data.subspan(at + size, size))) /
         double(bigEndian(data.subspan(at, size)));
}

// Resolutions are pixels per length, of any unit.
double statedRatio(std::span<const uint8_t> file) {
  constexpr uint16_t kXResolution = 282, kYResolution = 283;
  switch (imageFormat(file)) {
    case ImageFormat::Jpeg:
      // JFIF 1.02; after the version and the unit.
      return ratioIn(segmentOf(file, kApp0, std::string_view("JFIF\0", 5)), 3, 2);
    case ImageFormat::Png:
      return ratioIn(pngChunk(file, "pHYs"), 0, 4);
    case ImageFormat::Tiff: {
      const TiffBlock tiff(file);
      const auto x = tiff.find(tiff.firstDirectory(), kXResolution),
                 y = tiff.find(tiff.firstDirectory(), kYResolution);
      return x && y ? *y / *x : 1;
    }
    default:
      return 1;
  }
}

}  // namespace

Exif readExif(const std::filesystem::path& path) {
  const FileBytes file(path);
  const std::span<const uint8_t> bytes = file.bytes();
  if (imageFormat(bytes) == ImageFormat::Exr) return fromAttributes(readExrMetadata(path));
  const TiffBlock block(blockOf(bytes));
  const auto find = [&](Tag tag) { return findExif(block, tag); };
  return {find(kExposureTime), find(kFNumber), sensitivityOf(block), find(kFocalLengthIn35mmFilm)};
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

// ICC.1, annex B.4: a part begins with its number, from 1, and the number of all parts.
std::optional<std::vector<uint8_t>> jpegProfile(std::span<const uint8_t> file) {
  constexpr std::string_view kName("ICC_PROFILE\0", 12);
  constexpr size_t kCountBytes = 2;
  std::vector<std::span<const uint8_t>> parts = segmentsOf(file, kApp2, kName);
  if (parts.empty()) return {};
  std::ranges::stable_sort(parts, {}, [](std::span<const uint8_t> part) { return part.front(); });
  std::vector<uint8_t> profile;
  for (const std::span<const uint8_t> part : parts) {
    const auto data = part.subspan(std::min(kCountBytes, part.size()));
    profile.insert(profile.end(), data.begin(), data.end());
  }
  return profile;
}

// PNG (ISO/IEC 15948): a signature, then chunks of length, type, data and checksum.

std::span<const uint8_t> pngChunk(std::span<const uint8_t> file, std::string_view type) {
  constexpr size_t kSignatureBytes = 8, kHeadBytes = 8;  // length and type
  constexpr size_t kChecksumBytes = 4;
  for (size_t at = kSignatureBytes; at + kHeadBytes <= file.size();) {
    const uint64_t length = bigEndian(file.subspan(at, 4));
    const size_t begin = at + kHeadBytes;
    if (length > file.size() - begin) return {};
    if (textOf(file.subspan(at + 4, 4)) == type) return file.subspan(begin, size_t(length));
    at = begin + size_t(length) + kChecksumBytes;
  }
  return {};
}

std::optional<std::vector<uint8_t>> pngProfile(std::span<const uint8_t> file) {
  constexpr size_t kMostBytes = 1 << 20, kMethodBytes = 1;  // of compression, behind the name
  const std::span<const uint8_t> chunk = pngChunk(file, "iCCP");
  if (chunk.empty()) return {};
  const auto name = std::ranges::find(chunk, 0);
  if (chunk.end() - name <= ptrdiff_t(1 + kMethodBytes)) return std::vector<uint8_t>();
  const std::span<const uint8_t> packed(name + 1 + kMethodBytes, chunk.end());
  std::vector<uint8_t> profile(kMostBytes);
  uLongf size = kMostBytes;
  const bool isSound =
      uncompress(profile.data(), &size, packed.data(), uLong(packed.size())) == Z_OK;
  profile.resize(isSound ? size : 0);
  return profile;
}

double pixelAspectRatio(std::span<const uint8_t> file) {
  constexpr double kTolerance = 0.01;
  constexpr int kFirstOnItsSide = 5;
  const bool isOnItsSide = exifOrientation(file) >= kFirstOnItsSide;
  const double ratio = isOnItsSide ? 1 / statedRatio(file) : statedRatio(file);
  return ratio > 0 && std::isfinite(ratio) && std::abs(ratio - 1) > kTolerance ? ratio : 1;
}

}  // namespace chromeball
