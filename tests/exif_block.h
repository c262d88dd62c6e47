// SPDX-License-Identifier: Apache-2.0
// EXIF blocks, and images with them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chromeball {

// A value of an entry of a TIFF directory, as two numbers of 32 bits (a rational) or, if the second
// is 0, as one of 16 bits.
struct ExifEntry {
  uint16_t tag;
  uint32_t numerator, denominator;
};
inline ExifEntry exposureTime(uint32_t n, uint32_t d) { return {0x829a, n, d}; }
inline ExifEntry fNumber(uint32_t n, uint32_t d) { return {0x829d, n, d}; }
inline ExifEntry isoSpeed(uint32_t iso) { return {0x8827, iso, 0}; }

// A first directory with only an orientation.
std::string orientationBlock(int orientation);

// A first directory with a pointer to one with these entries.
std::string exifBlock(const std::vector<ExifEntry>& entries, bool bigEndian = true);

std::string bigEndian(size_t value, int bytes);

// The JPEG or PNG with the block before its other segments or chunks.
std::string withExif(const std::string& file, const std::string& block);

}  // namespace chromeball
