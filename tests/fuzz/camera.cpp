// SPDX-License-Identifier: Apache-2.0
// What `camera solve` and `--camera-file` read: files of fSpy, tables of points and lines, and
// files with a section [camera].
#include "front/scene_file.h"
#include "front/scene_file_sections.h"
#include "fuzz.h"
#include "scene/solve/observations.h"
#include "scene/solve/solve_camera.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string path = fuzzFile(bytes, size, "camera");
  for (const bool zUp : {false, true}) readOrReject([&] { readFspy(path, zUp); });
  readOrReject([&] { readObservedPoints(path); });
  readOrReject([&] { readObservedLines(path); });
  return readOrReject([&] {
    SceneFile scene;
    readCameraFile(path, scene);
  });
}
