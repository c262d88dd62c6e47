// SPDX-License-Identifier: Apache-2.0
#include "image/io/image_format.h"

#include <string_view>
#include <utility>

namespace chromeball {

ImageFormat imageFormat(std::span<const uint8_t> firstBytes) {
  constexpr std::pair<std::string_view, ImageFormat> kMagic[] = {
      {"\x76\x2f\x31\x01", ImageFormat::Exr},
      {"#?", ImageFormat::RadianceHdr},
      {"PF", ImageFormat::Pfm},
      {"Pf", ImageFormat::Pfm},
      {"\x89PNG", ImageFormat::Png},
      {"\xff\xd8\xff", ImageFormat::Jpeg},
      {std::string_view("II*\0", 4), ImageFormat::Tiff},
      {std::string_view("MM\0*", 4), ImageFormat::Tiff},
      {std::string_view("II+\0", 4), ImageFormat::Tiff},  // BigTIFF
      {std::string_view("MM\0+", 4), ImageFormat::Tiff}};
  const std::string_view bytes(reinterpret_cast<const char*>(firstBytes.data()), firstBytes.size());
  for (const auto& [magic, format] : kMagic)
    if (bytes.starts_with(magic)) return format;
  constexpr size_t kTypeAt = 8;  // after the size
  if (bytes.starts_with("RIFF") && bytes.size() > kTypeAt &&
      bytes.substr(kTypeAt).starts_with("WEBP"))
    return ImageFormat::Webp;
  return ImageFormat::Unknown;
}

}  // namespace chromeball
