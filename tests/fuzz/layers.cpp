// SPDX-License-Identifier: Apache-2.0
// The part of renders that `compare` and `image` read: layers, colour and metadata of an EXR of any
// compression, with scanlines or tiles.
#include <algorithm>
#include <vector>

#include "fuzz.h"
#include "image/io/read_image.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  constexpr uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01};
  std::vector<uint8_t> exr(bytes, bytes + size);
  std::copy_n(kMagic, std::min(size, sizeof kMagic), exr.begin());
  const std::string path = fuzzFile(exr.data(), exr.size(), "render.exr");
  return readOrReject([&] {
    const ImageFile file = readImageFile(path);
    const size_t texels = size_t(file.image.width) * size_t(file.image.height);
    if (file.image.texels.size() != texels * file.channels.size()) std::abort();
    if (file.image.texels.size() > 1 << 20) return;  // copied slowly under the sanitizers
    findColor(file);
    for (const std::string& layer : layerNames(file)) {
      const auto found = findLayer(file, layer);
      if (found && found->texels.size() != texels * size_t(found->channels)) std::abort();
    }
  });
}
