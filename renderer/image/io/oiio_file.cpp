// SPDX-License-Identifier: Apache-2.0
#include "image/io/oiio_file.h"

#include <algorithm>

#include "image/size_limits.h"

namespace chromeball {

namespace fs = std::filesystem;

// Text before the path is dropped, since our message starts with the path, unless the path comes
// last. Characters that are not printable are replaced, since names in a damaged file may hold any
// bytes.
void throwUnreadable(const fs::path& path, std::string reason) {
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

Metadata metadataOf(const OIIO::ImageSpec& spec) {
  Metadata metadata;
  for (const OIIO::ParamValue& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    if (attribute.type() == OIIO::TypeDesc::INT)
      metadata[name] = attribute.get_int();
    else if (attribute.type() == OIIO::TypeDesc::FLOAT)
      metadata[name] = attribute.get_float();
    else if (attribute.type() == OIIO::TypeDesc::STRING)
      metadata[name] = attribute.get_string(0);
    else if (attribute.type() == OIIO::TypeMatrix)
      std::copy_n(static_cast<const float*>(attribute.data()), 16,
                  std::get<Matrix44>(metadata[name] = Matrix44{}).begin());
  }
  return metadata;
}

// The compression ratio of OpenEXR and TIFF has no known bound; kMaxRatio is an estimate, which
// small images may exceed. stripJpeg() checks the frames of a JPEG.
void checkFileLength(const fs::path& path, std::string_view reader, const OIIO::ImageSpec& spec) {
  constexpr uint64_t kAlwaysAllowed = 64 << 20, kMaxRatio = 100'000;
  const uint64_t decodedBytes = spec.image_bytes(true), fileBytes = fs::file_size(path);
  const uint64_t maxBytes =
      std::max(kAlwaysAllowed, fileBytes * (reader == "png" ? kMaxDeflateRatio : kMaxRatio));
  if (decodedBytes > maxBytes)
    throwInput("{}: too short for {} x {} texels", path.string(), spec.width, spec.height);
}

}  // namespace chromeball
