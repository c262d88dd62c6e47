// SPDX-License-Identifier: Apache-2.0
#include "image/io/image_format.h"

#include <array>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"

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
  const std::string_view bytes = textOf(firstBytes);
  for (const auto& [magic, format] : kMagic)
    if (bytes.starts_with(magic)) return format;
  constexpr size_t kTypeAt = 8;  // after the size
  if (bytes.starts_with("RIFF") && bytes.size() > kTypeAt &&
      bytes.substr(kTypeAt).starts_with("WEBP"))
    return ImageFormat::Webp;
  return ImageFormat::Unknown;
}

ImageFormat imageFormat(const std::filesystem::path& path) {
  checkReadable(path);
  std::array<uint8_t, 12> bytes{};  // that the function above looks at, at most
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  return imageFormat(std::span(bytes).first(size_t(stream.gcount())));
}

bool isOfResources(const std::exception& error) {
  return dynamic_cast<const std::system_error*>(&error) != nullptr;
}

// Text before the path is dropped, since our message starts with the path, unless the path comes
// last. Characters that are not printable are replaced, since names in a damaged file may hold any
// bytes.
void throwUnreadable(const std::filesystem::path& path, std::string reason) {
  constexpr const char* kPunctuation = "\"'.:() \n";
  const size_t pathBegin = reason.rfind(path.string());
  if (pathBegin != std::string::npos) {
    const std::string after = reason.substr(pathBegin + path.string().size());
    const size_t textBegin = after.find_first_not_of(kPunctuation);
    if (textBegin != std::string::npos) {
      reason = after.substr(textBegin);
    } else {
      reason = reason.substr(0, pathBegin);
      reason.erase(reason.find_last_not_of(kPunctuation) + 1);
    }
  }
  reason.erase(reason.find_last_not_of(".: \n") + 1);
  for (char& c : reason)
    if (c < ' ' || c > '~') c = c == '\n' ? ' ' : '?';
  throwInput("{}: cannot be read: {}", path.string(),
             reason.empty() ? "it is damaged or of an unknown format" : reason);
}

}  // namespace chromeball
