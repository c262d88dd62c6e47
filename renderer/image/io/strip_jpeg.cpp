// SPDX-License-Identifier: Apache-2.0
// JPEG (ITU-T T.81, annex B): markers, most of them followed by a segment of a stated length, up to
// the first start of scan.
#include <algorithm>
#include <string_view>

#include "image/io/strip_metadata.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

enum Marker : uint8_t {
  kTem = 0x01,
  kSof0 = 0xc0,
  kDht = 0xc4,
  kJpg = 0xc8,
  kDac = 0xcc,
  kSof15 = 0xcf,
  kRst0 = 0xd0,
  kSoi = 0xd8,
  kEoi = 0xd9,
  kSos = 0xda,
  kApp0 = 0xe0,   // JFIF
  kApp1 = 0xe1,   // EXIF, XMP
  kApp14 = 0xee,  // Adobe: colour is YCbCr, RGB, CMYK or YCCK
  kApp15 = 0xef,
  kCom = 0xfe
};

bool isFrame(uint8_t marker) {
  return marker >= kSof0 && marker <= kSof15 && marker != kDht && marker != kJpg && marker != kDac;
}

bool isMetadata(uint8_t marker) {
  return marker == kCom || (marker > kApp0 && marker <= kApp15 && marker != kApp14);
}

bool standsAlone(uint8_t marker) { return marker == kTem || (marker >= kRst0 && marker <= kSoi); }

int bigEndian16(const uint8_t* bytes) { return bytes[0] << 8 | bytes[1]; }

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
  if (standsAlone(marker) || marker == kEoi) return at;
  if (file.size() - at < 2) return file.size();
  return std::min(at + size_t(std::max(bigEndian16(&file[at]), 2)), file.size());
}

// The first scan begins at `at`. In coded data, 0xff is followed by 0 or a restart marker.
void checkScans(std::span<const uint8_t> file, size_t at, const std::string& name) {
  int count = 0;
  for (uint8_t marker; (marker = nextMarker(file, at)) && marker != kEoi;) {
    if (marker == kSos && ++count > kMaxJpegScans)
      throwInput("{}: damaged image: more than {} scans", name, kMaxJpegScans);
    at = endOfSegment(file, at, marker);
  }
}

constexpr size_t kFrameBytes = 8;  // length, precision, height, width, components

HeaderSize frameSize(std::span<const uint8_t> segment) {
  return {bigEndian16(&segment[5]), bigEndian16(&segment[3])};
}

void readFrame(std::span<const uint8_t> segment, size_t fileBytes, const std::string& name,
               StrippedJpeg& jpeg) {
  if (segment.size() < kFrameBytes) return;
  const HeaderSize size = frameSize(segment);
  jpeg.width = size.width;
  jpeg.height = size.height;
  jpeg.components = segment[7];
  if (uint64_t(jpeg.width) * uint64_t(jpeg.height) > fileBytes * kMaxTexelsPerJpegByte)
    throwInput("{}: damaged image: {} x {} texels cannot fit into {} bytes", name, jpeg.width,
               jpeg.height, fileBytes);
}

}  // namespace

HeaderSize jpegSize(std::span<const uint8_t> file) {
  size_t at = 0;
  while (const uint8_t marker = nextMarker(file, at)) {
    if (marker == kSos || marker == kEoi) break;
    const size_t begin = at;
    at = endOfSegment(file, at, marker);
    if (isFrame(marker) && at - begin >= kFrameBytes)
      return frameSize(file.subspan(begin, at - begin));
  }
  return {};
}

std::span<const uint8_t> jpegExif(std::span<const uint8_t> file) {
  constexpr std::string_view kName("Exif\0\0", 6);
  constexpr size_t kLengthBytes = 2, kBlockAt = kLengthBytes + kName.size();
  size_t at = 0;
  while (const uint8_t marker = nextMarker(file, at)) {
    if (marker == kSos || marker == kEoi) break;
    const size_t begin = at;
    at = endOfSegment(file, at, marker);
    const std::span<const uint8_t> segment = file.subspan(begin, at - begin);
    if (marker == kApp1 && segment.size() > kBlockAt &&
        std::equal(kName.begin(), kName.end(), segment.begin() + kLengthBytes))
      return segment.subspan(kBlockAt);
  }
  return {};
}

StrippedJpeg stripJpeg(std::span<const uint8_t> file, const std::string& name) {
  StrippedJpeg jpeg;
  jpeg.file.reserve(file.size());
  const auto keep = [&](size_t begin, size_t end) {
    jpeg.file.insert(jpeg.file.end(), file.begin() + std::ptrdiff_t(begin),
                     file.begin() + std::ptrdiff_t(end));
  };
  size_t at = 0;
  while (const uint8_t marker = nextMarker(file, at)) {
    const size_t begin = at - 2;
    if (marker == kSos || marker == kEoi) {
      checkScans(file, begin, name);
      keep(begin, file.size());
      break;
    }
    at = endOfSegment(file, at, marker);
    if (isFrame(marker))
      readFrame(file.subspan(begin + 2, at - begin - 2), file.size(), name, jpeg);
    if (!isMetadata(marker)) keep(begin, at);
  }
  if (jpeg.components == 0) throwInput("{}: damaged image: no frame header", name);
  return jpeg;
}

}  // namespace chromeball
