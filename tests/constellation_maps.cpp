// SPDX-License-Identifier: Apache-2.0
#include "constellation_maps.h"

#include <algorithm>

#include "base/hash.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "shared_data.h"

namespace chromeball {

std::vector<std::string_view> constellationNames() {
  std::vector<std::string_view> names;
  for (const LightingMethod& method : lightingMethods())
    if (method.lights.keepsEnergy) names.push_back(method.name);
  return names;
}

int countFor(std::string_view method, int lights) {
  return method == "cube-grid" ? std::clamp(int(std::sqrt(lights / 6.0)), 1, 26) : lights;
}

Constellation make(std::string_view method, const Image& map, int lights, uint64_t seed) {
  return makeLights(method, map, {.count = countFor(method, lights), .seed = seed}).lights;
}

Image noise(int width, int height) {
  Image map(width, height, 3);
  for (size_t i = 0; i < map.texels.size(); ++i)
    map.texels[i] = std::pow(toUnit(uint32_t(hash(7, i))), 4.0f) + 0.01f;
  return map;
}

std::vector<Image> realProbes(int maximum) {
  std::vector<Image> maps;
  for (const char* file :
       {"probes/probulator/grace_latlong_small.hdr", "probes/probulator/uffizi_latlong_small.hdr",
        "probes/probulator/ennis_latlong_small.hdr", "probes/probulator/pisa_latlong_small.hdr",
        "probes/probulator/wells_latlong_small.hdr", "probes/misc/mitsuba_museum.exr",
        "probes/polyhaven/kloppenheim_05_1k.hdr", "probes/polyhaven/studio_small_05_1k.hdr"})
    if (const auto path = sharedData(file); path && int(maps.size()) < maximum)
      maps.push_back(loadProbe(*path).latLong);
  return maps;
}

std::optional<Image> smallProbe(const std::string& file) {
  const auto path = sharedData("probes/" + file);
  if (!path) return std::nullopt;
  return convert(loadProbe(*path).latLong, Mapping::LatLong, Mapping::LatLong, {256, 128});
}

}  // namespace chromeball
