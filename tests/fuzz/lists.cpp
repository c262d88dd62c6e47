// SPDX-License-Identifier: Apache-2.0
// Lists of lights and of polygons in a probe; what is read must be usable.
#include "front/polygon_file.h"
#include "fuzz.h"
#include "lighting/export/light_file.h"
#include "math/vec.h"
#include "probe/synth.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string path = fuzzFile(bytes, size, "list.json");
  readOrReject([&] {
    for (const DirectionalLight& light : readLights(path).lights)
      if (!isFinite(light.direction) || !isFinite(light.irradiance)) std::abort();
  });
  static const LoadedProbe probe = [] {
    LoadedProbe made;
    made.latLong = constantProbe({64, 32}, Rgb(1));
    made.fileWidth = 64, made.fileHeight = 32;
    return made;
  }();
  return readOrReject([&] {
    for (const PolygonCorners& corners : readPolygons(path))
      if (!(polygonOf(corners, probe, "polygon").solidAngle() > 0)) std::abort();
  });
}
