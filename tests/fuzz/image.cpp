// SPDX-License-Identifier: Apache-2.0
// Every image reader (selected by the first bytes), as a texture of a model and as an image file;
// the layers of an EXR; and the conversion to a probe.
#include "fuzz.h"
#include "image/io/decode_image.h"
#include "image/io/read_image.h"
#include "probe/load.h"
#include "probe/probe.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string path = fuzzFile(bytes, size, "image");
  readOrReject([&] { decodeImage({bytes, size}, "texture"); });
  return readOrReject([&] {
    const ImageFile file = readImageFile(path);
    if (file.image.texels.size() > 1 << 20) return;  // copied slowly under the sanitizers
    for (const std::string& layer : layerNames(file)) findLayer(file, layer);
    const auto color = findColor(file);
    if (!color) return;
    const LoadedProbe loaded = loadProbe(path, "auto", "");
    if (!isFinite(Probe(loaded.latLong).radiance({0, 1, 0}))) std::abort();
  });
}
