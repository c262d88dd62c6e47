// SPDX-License-Identifier: Apache-2.0
#include "image/io/pixel_aspect.h"

#include <cmath>

#include "image/io/exif.h"
#include "image/io/image_format.h"
#include "image/io/metadata_blocks.h"
#include "image/io/tiff_block.h"

namespace chromeball {
namespace {

double bigEndianNumber(std::span<const uint8_t> bytes) {
  double number = 0;
  for (const uint8_t byte : bytes) number = 256 * number + byte;
  return number;
}

// Numbers of `size` bytes, that of the width first.
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
