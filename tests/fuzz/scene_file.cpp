// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file.h"

#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string path = fuzzFile(bytes, size, "scene.toml");
  return readOrReject([&] { readSceneFile(path); });
}
