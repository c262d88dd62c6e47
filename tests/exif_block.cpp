// SPDX-License-Identifier: Apache-2.0
#include "exif_block.h"

namespace chromeball {

std::string orientationBlock(int orientation) {
  std::string block("MM\0*\0\0\0\10\0\1\1\22\0\3\0\0\0\1\0\0\0\0\0\0\0\0", 26);
  block[19] = char(orientation);
  return block;
}

std::string exifBlock(const std::vector<ExifEntry>& entries, bool bigEndian) {
  std::string block;
  const auto put = [&](uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
      block += char(value >> 8 * (bigEndian ? bytes - 1 - i : i) & 0xff);
  };
  block += bigEndian ? "MM" : "II";
  put(42, 2), put(8, 4);
  const uint32_t second = 8 + 2 + 12 + 4;
  put(1, 2), put(0x8769, 2), put(4, 2), put(1, 4), put(second, 4), put(0, 4);
  uint32_t values = second + 2 + 12 * uint32_t(entries.size()) + 4;
  put(uint32_t(entries.size()), 2);
  for (const ExifEntry& entry : entries) {
    put(entry.tag, 2), put(entry.denominator ? 5 : 3, 2), put(1, 4);
    if (entry.denominator == 0) {
      put(entry.numerator, 2), put(0, 2);
    } else {
      put(values, 4);
      values += 8;
    }
  }
  put(0, 4);
  for (const ExifEntry& entry : entries)
    if (entry.denominator != 0) put(entry.numerator, 4), put(entry.denominator, 4);
  return block;
}

std::string bigEndian(size_t value, int bytes) {
  std::string text;
  while (bytes-- > 0) text += char(value >> 8 * bytes & 0xff);
  return text;
}

std::string withExif(const std::string& file, const std::string& block) {
  const std::string name("Exif\0\0", 6);
  const bool isJpeg = file[0] == '\xff';
  const size_t at = isJpeg ? 2 : 8 + 25;  // after the start of the image, or signature and header
  std::string result(file, 0, at);
  if (isJpeg)
    result.append("\xff\xe1").append(bigEndian(2 + name.size() + block.size(), 2)).append(name);
  else
    result.append(bigEndian(block.size(), 4)).append("eXIf");
  result.append(block);
  if (!isJpeg) result.append("\1\2\3\4");  // a checksum that nobody checks
  return result.append(file, at);
}

}  // namespace chromeball
