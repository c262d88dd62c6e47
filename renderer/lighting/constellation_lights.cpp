// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation_lights.h"

#include <limits>

#include "lighting/constellation/cube_grid.h"
#include "lighting/constellation/kollig_keller.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/penrose.h"

namespace chromeball {
namespace {

using Lights = LightingMethod::Lights;

// Deterministic methods.
Lights constellation(CountRange counts, Constellation (*make)(const Image& latLong, int count),
                     Partition (*regions)(const Image& latLong, int count)) {
  return {.make =
              [make](const Image& latLong, const LightRequest& request) {
                return MadeLights{make(latLong, *request.count)};
              },
          .counts = counts,
          .keepsEnergy = true,
          .regions =
              [regions](const Image& latLong, const LightRequest& request) {
                return LightRegions{regions(latLong, *request.count), {}};
              }};
}

// Stochastic methods.
Lights constellation(CountRange counts,
                     Constellation (*make)(const Image& latLong, int count, uint64_t seed),
                     LightRegions (*regions)(const Image& latLong, const LightRequest& request)) {
  return {.make =
              [make](const Image& latLong, const LightRequest& request) {
                return MadeLights{make(latLong, *request.count, request.seed)};
              },
          .counts = counts,
          .isStochastic = true,
          .keepsEnergy = true,
          .regions = regions};
}

LightRegions lightGenClusters(const Image& latLong, const LightRequest& request) {
  return {lightGenRegions(latLong, *request.count, request.seed), {}};
}

LightRegions kolligKellerClusters(const Image& latLong, const LightRequest& request) {
  return {kolligKellerRegions(latLong, *request.count), {}};
}

LightRegions penroseRhombs(const Image& latLong, const LightRequest& request) {
  return {{}, penroseTiling(latLong, *request.count, request.seed)};
}

LevelCut levelCutOf(RegionMeasure measure, LightPlace place, const LightRequest& request) {
  LevelCut cut{.measure = measure, .place = place};
  if (request.levels) cut.levels = *request.levels, cut.count = std::numeric_limits<int>::max();
  if (request.count) cut.count = *request.count;
  return cut;
}

Lights levelCutLights(CountRange counts, RegionMeasure measure, LightPlace place) {
  return {.make =
              [=](const Image& latLong, const LightRequest& request) {
                return MadeLights{levelCut(latLong, levelCutOf(measure, place, request))};
              },
          .counts = counts,
          .takesLevels = true,
          .keepsEnergy = true,
          .regions =
              [=](const Image& latLong, const LightRequest& request) {
                const LevelCut cut = levelCutOf(measure, place, request);
                return LightRegions{levelCutPartition(latLong, cut), {}};
              }};
}

}  // namespace

Lights medianCutLights(CountRange counts) {
  Lights byEnergy = constellation(counts, medianCut, medianCutPartition);
  const Lights byLevel = levelCutLights(counts, RegionMeasure::SolidAngle, LightPlace::Centroid);
  const auto either = [](const auto& one, const auto& other) {
    return [=](const Image& latLong, const LightRequest& request) {
      return request.levels ? other(latLong, request) : one(latLong, request);
    };
  };
  byEnergy.make = either(byEnergy.make, byLevel.make);
  byEnergy.regions = either(byEnergy.regions, byLevel.regions);
  byEnergy.takesLevels = true;
  return byEnergy;
}

Lights centreCutLights(CountRange counts) {
  return levelCutLights(counts, RegionMeasure::SolidAngle, LightPlace::Centre);
}

Lights flatCutLights(CountRange counts) {
  return levelCutLights(counts, RegionMeasure::MapArea, LightPlace::Centre);
}

Lights varianceCutLights(CountRange counts) {
  return constellation(counts, varianceCut, varianceCutPartition);
}

Lights lightGenLights(CountRange counts) {
  return constellation(counts, lightGen, lightGenClusters);
}

Lights kolligKellerLights(CountRange counts) {
  return constellation(counts, kolligKeller, kolligKellerRegions);
}

Lights strataLights(CountRange counts) {
  return constellation(counts, kolligKellerStrata, kolligKellerClusters);
}

Lights cubeGridLights(CountRange counts) {
  return constellation(counts, cubeGrid, cubeGridRegions);
}

Lights penroseLights(CountRange counts) { return constellation(counts, penrose, penroseRhombs); }

}  // namespace chromeball
