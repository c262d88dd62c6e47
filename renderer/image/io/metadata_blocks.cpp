// SPDX-License-Identifier: Apache-2.0
// JPEG (ITU-T T.81, annex B): markers, most of them followed by a segment of a stated length, up to
// the first start of scan.
#include "image/io/metadata_blocks.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "image/io/exif.h"
#include "image/io/image_format.h"
#include "image/io/tiff_block.h"

namespace chromeball {

// JPEG (ITU-T T.81, annex B): markers, most of them followed by a segment of a stated length, up to
// the first start of scan.

namespace {

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
        std::equal(name.begin(), name.end(), segment.begin() + kLengthBytes))
      found.push_back(segment.subspan(dataAt));
  }
  return found;
}

std::span<const uint8_t> segmentOf(std::span<const uint8_t> file, uint8_t wanted,
                                   std::string_view name) {
  const auto found = segmentsOf(file, wanted, name);
  return found.empty() ? std::span<const uint8_t>() : found.front();
}

}  // namespace

std::span<const uint8_t> jpegExif(std::span<const uint8_t> file) {
  return segmentOf(file, kApp1, kExifName);
}

std::span<const uint8_t> jpegJfif(std::span<const uint8_t> file) {
  return segmentOf(file, kApp0, std::string_view("JFIF\0", 5));
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
    const uint8_t* head = &file[at];
    const uint64_t length = uint64_t(head[0]) << 24 | head[1] << 16 | head[2] << 8 | head[3];
    const size_t begin = at + kHeadBytes;
    if (length > file.size() - begin) return {};
    if (std::string_view(reinterpret_cast<const char*>(head + 4), 4) == type)
      return file.subspan(begin, size_t(length));
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

// Some writers begin the block with the name that it has in a JPEG.
std::span<const uint8_t> pngExif(std::span<const uint8_t> file) {
  const std::span<const uint8_t> chunk = pngChunk(file, "eXIf");
  const bool isNamed = chunk.size() >= kExifName.size() &&
                       std::equal(kExifName.begin(), kExifName.end(), chunk.begin());
  return isNamed ? chunk.subspan(kExifName.size()) : chunk;
}

namespace {

double bigEndianNumber(std::span<const uint8_t> bytes) {
  double number = 0;
  for (const uint8_t byte : bytes) number = 256 * number + byte;
  return number;
}

// The ratio of two numbers of `size` bytes, the width's first.
double ratioIn(std::span<const uint8_t> data, size_t at, size_t size) {
  if (data.size() < at + 2 * size) return 1;
  return bigEndianNumber(data.subspan(at + size, size)) / bigEndianNumber(data.subspan(at, size));
}

// Resolutions are pixels per length, of any unit.
double statedRatio(std::span<const uint8_t> file) {
  constexpr uint16_t kXResolution = 282, kYResolution = 283;
  switch (imageFormat(file)) {
    case ImageFormat::Jpeg:
      return ratioIn(jpegJfif(file), 3, 2);  // after the version and the unit
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

double pixelAspectRatio(std::span<const uint8_t> file) {
  constexpr double kTolerance = 0.01;
  constexpr int kFirstOnItsSide = 5;
  const bool isOnItsSide = exifOrientation(file) >= kFirstOnItsSide;
  const double ratio = isOnItsSide ? 1 / statedRatio(file) : statedRatio(file);
  return ratio > 0 && std::isfinite(ratio) && std::abs(ratio - 1) > kTolerance ? ratio : 1;
}

}  // namespace chromeball
