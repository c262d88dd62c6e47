// SPDX-License-Identifier: Apache-2.0
// Light stages: the header, the layers of the basis, and bands of rows.
#include "relight/stage/stage_file.h"

#include <algorithm>
#include <vector>

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  constexpr uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01};
  constexpr int kMostRows = 64;
  std::vector<uint8_t> exr(bytes, bytes + size);
  std::copy_n(kMagic, std::min(size, sizeof kMagic), exr.begin());
  const std::string path = fuzzFile(exr.data(), exr.size(), "stage.exr");
  return readOrReject([&] {
    StageReader reader(path);
    if (double(reader.height()) * reader.rowBytes() > 1 << 22) return;  // slow under the sanitizers
    for (int top = 0; top < std::min(reader.height(), kMostRows); top += 3) {
      const LightStage band = reader.read(top, std::min(3, reader.height() - top));
      if (band.elements.channels != 3 * reader.basis().size()) std::abort();
    }
  });
}
