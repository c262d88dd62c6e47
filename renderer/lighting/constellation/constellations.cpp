// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/constellations.h"

#include "base/error.h"
#include "base/suggest.h"
#include "lighting/constellation/cube_grid.h"
#include "lighting/constellation/kollig_keller.h"
#include "lighting/constellation/lightgen.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/penrose.h"
#include "lighting/constellation/variance_cut.h"

namespace chromeball {
namespace {

struct Method {
  const char* name;
  int minimum, maximum;  // count
  Constellation (*make)(const Image& latLong, int count, uint64_t seed);
};

const Method kMethods[] = {
    {"median-cut", 2, 4096,
     [](const Image& map, int count, uint64_t) { return medianCut(RegionTable(map), count); }},
    {"variance-cut", 2, 4096,
     [](const Image& map, int count, uint64_t) { return varianceCut(RegionTable(map), count); }},
    {"lightgen", 2, 4096,
     [](const Image& map, int count, uint64_t seed) {
       return lightGen(TexelTable(map, kCoarseCells), count, seed);
     }},
    {"kollig-keller", 2, 4096,
     [](const Image& map, int count, uint64_t) {
       return kolligKeller(TexelTable(map, kCoarseCells), count);
     }},
    {"kollig-keller-strata", 2, 4096, kolligKellerStrata},
    {"cube-grid", 1, 26,
     [](const Image& map, int n, uint64_t) { return cubeGrid(TexelTable(map, kFineCells), n); }},
    {"penrose", 2, 4096,
     [](const Image& map, int count, uint64_t seed) {
       return penrose(ImportanceTable(map), count, seed);
     }},
};

}  // namespace

std::vector<std::string_view> constellationNames() {
  std::vector<std::string_view> names;
  for (const Method& method : kMethods) names.push_back(method.name);
  return names;
}

Constellation makeConstellation(const std::string& method, const Image& latLong, int count,
                                uint64_t seed) {
  for (const Method& known : kMethods) {
    if (method != known.name) continue;
    if (count < known.minimum || count > known.maximum)
      throwInput("{}: a count of {} is out of range; give {} to {}", method, count, known.minimum,
                 known.maximum);
    return known.make(latLong, count, seed);
  }
  throwInput("constellation `{}` is not known; {}", method,
             didYouMean(method, constellationNames()));
}

}  // namespace chromeball
