// SPDX-License-Identifier: Apache-2.0
// EXIF: as a TIFF, which it is; as a file of any format; and as a PNG's chunk or a JPEG's segment.
#include "image/io/exif.h"

#include <cmath>
#include <span>

#include "fuzz.h"

namespace chromeball {
namespace {

std::string bigEndian(size_t number, int count) {
  std::string bytes;
  for (int shift = 8 * (count - 1); shift >= 0; shift -= 8) bytes += char(number >> shift);
  return bytes;
}

std::string inPng(const std::string& block) {
  return "\x89PNG\r\n\x1a\n" + bigEndian(block.size(), 4) + "eXIf" + block + bigEndian(0, 4);
}

std::string inJpeg(const std::string& block) {
  const std::string segment = std::string("Exif\0\0", 6) + block;
  return "\xff\xd8\xff\xe1" + bigEndian(segment.size() + 2, 2) + segment + "\xff\xd9";
}

void read(const std::string& file) {
  const std::string path =
      fuzzFile(reinterpret_cast<const uint8_t*>(file.data()), file.size(), "photograph");
  readOrReject([&] {
    const Exif exif = readExif(path);
    for (const auto& value : {exif.exposureTime, exif.aperture, exif.iso, exif.focalLength35})
      if (value && !(*value > 0 && std::isfinite(*value))) std::abort();
  });
}

}  // namespace
}  // namespace chromeball

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string block(reinterpret_cast<const char*>(bytes), size);
  read(block);
  read(inPng(block));
  if (size < 65000) read(inJpeg(block));
  return 0;
}
