// SPDX-License-Identifier: Apache-2.0
// Removes metadata from image files: colour profiles, EXIF, comments. We do not use them, and
// libraries do not parse damaged ones safely: OpenImageIO 2.4 follows the tag table of an ICC
// profile beyond the end of the profile.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

// Of an image, as its header states it; 0 if that is damaged.
struct HeaderSize {
  int width = 0, height = 0;
};

HeaderSize jpegSize(std::span<const uint8_t> file);
HeaderSize pngSize(std::span<const uint8_t> file);

// The EXIF block (exif.h), a part of `file`; empty if there is none.
std::span<const uint8_t> jpegExif(std::span<const uint8_t> file);
std::span<const uint8_t> pngExif(std::span<const uint8_t> file);

// A JPEG without its metadata segments, except those of JFIF and Adobe, which tell how colour is
// encoded. The size is that of the frame header (SOF), so that it can be checked before a library
// allocates memory for it.
struct StrippedJpeg {
  std::vector<uint8_t> file;
  int width = 0, height = 0, components = 0;
};

// Throws InputError ("NAME: ...") if there is no frame, if the frame has more texels than the bytes
// can hold, or if there are more than kMaxJpegScans scans. The library detects other damage.
StrippedJpeg stripJpeg(std::span<const uint8_t> file, const std::string& name);

// Each scan of a progressive JPEG visits every block, even if the scan has only a dozen bytes.
// Encoders write about ten scans.
inline constexpr int kMaxJpegScans = 100;

// Keeps the critical chunks and the transparency of a palette or key colour (tRNS).
std::vector<uint8_t> stripPng(std::span<const uint8_t> file);

// Removes the metadata entries from the first directory; other directories are not read.
std::vector<uint8_t> stripTiff(std::span<const uint8_t> file);

}  // namespace chromeball
