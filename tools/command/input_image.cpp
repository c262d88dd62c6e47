// SPDX-License-Identifier: Apache-2.0
#include "input_image.h"

#include "messages.h"

namespace chromeball {

ImageFile openImageFile(const std::filesystem::path& path, IntegerTexels integers) {
  ImageFile file = readImageFile(path, integers);
  print(file.messages, false);
  return file;
}

Image openImage(const std::filesystem::path& path, IntegerTexels integers) {
  return colorOf(openImageFile(path, integers), path);
}

LoadedProbe openProbe(const std::string& path, std::string_view mapping, std::string_view option) {
  LoadedProbe probe = loadProbe(path, mapping, option);
  print(probeMessages(probe, path), false);
  return probe;
}

}  // namespace chromeball
