// SPDX-License-Identifier: Apache-2.0
#include "input_image.h"

#include <fmt/format.h>

#include "base/file.h"
#include "messages.h"

namespace chromeball {

ImageFile openImageFile(const std::filesystem::path& path, IntegerTexels integers) {
  ImageFile file = readImageFile(path, integers);
  print(file.messages);
  return file;
}

Image openImage(const std::filesystem::path& path, IntegerTexels integers) {
  return colorOf(openImageFile(path, integers), path);
}

Metadata keptMetadata(const ImageFile& file, const std::string& in, const std::string& out) {
  Metadata kept = file.metadata;
  const auto envmap = kept.find(kEnvmapAttribute);
  if (envmap == kept.end()) return kept;
  const auto* kind = std::get_if<std::string>(&envmap->second);
  if (kind && *kind == kEnvmapLatLong && lowerExtension(out) != ".png")
    warn(
        "{}: its `envmap` attribute, which puts +Z in the centre, is not kept: as a "
        "probe, {} needs a rotation of 180 degrees",
        in, out);
  kept.erase(envmap);
  return kept;
}

LoadedProbe openProbe(const std::string& path, std::string_view mapping, std::string_view option) {
  LoadedProbe probe = loadProbe(path, mapping, option);
  print(probeMessages(probe, path));
  return probe;
}

}  // namespace chromeball
