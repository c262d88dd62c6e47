// SPDX-License-Identifier: Apache-2.0
// Image files without what is not their picture: colour profiles, EXIF, comments. Nothing here uses
// those, and what libraries make of damaged ones is not safe: OpenImageIO 2.4 follows the tag table
// of an ICC profile out of the profile.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

// Of a JPEG remain JFIF's and Adobe's segments, which say how colour is coded. Its size is the
// frame header's (SOF), so that it can be judged before a library takes memory for it.
struct BareJpeg {
  std::vector<uint8_t> file;
  int width = 0, height = 0, components = 0;
};

// Other damage is left for the library to find. Throws InputError ("NAME: ...") where there is no
// frame, where it has more texels than the bytes can hold, and for more than kMaxJpegScans scans.
BareJpeg bareJpeg(std::span<const uint8_t> file, const std::string& name);

// Each scan of a progressive JPEG visits every block, for as few as a dozen bytes. Encoders write
// about ten.
inline constexpr int kMaxJpegScans = 100;

// Of a PNG remain the critical chunks and the transparency of a palette or key.
std::vector<uint8_t> barePng(std::span<const uint8_t> file);

// Of a TIFF's first directory all entries remain but those of metadata; other directories are not
// read.
std::vector<uint8_t> bareTiff(std::span<const uint8_t> file);

}  // namespace chromeball
