// SPDX-License-Identifier: Apache-2.0
#include "lighting/methods.h"

#include <limits>

#include "lighting/constellation/cube_grid.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/penrose.h"
#include "lighting/constellation/spherical_kmeans.h"

namespace chromeball {
namespace {

using Lights = LightingMethod::Lights;

// A light for each rectangle of cut(table, request).
template <class Cut>
Lights cutLights(CountRange counts, RegionMeasure measure, LightPlace place, const Cut& cut) {
  return {.make =
              [=](const Image& latLong, const LightRequest& request) {
                const RegionTable table(latLong, measure);
                return MadeLights{table.lights(cut(table, request), place)};
              },
          .counts = counts,
          .keepsEnergy = true,
          .regions =
              [=](const Image& latLong, const LightRequest& request) {
                const RegionTable table(latLong, measure);
                return LightRegions{table.partition(latLong, cut(table, request)), {}};
              }};
}

std::vector<Region> levelCutOf(const RegionTable& table, const LightRequest& request) {
  constexpr int kAll = std::numeric_limits<int>::max(), kUsualCount = 64;
  return levelCutRegions(table, request.levels.value_or(kAll),
                         request.count.value_or(request.levels ? kAll : kUsualCount));
}

Lights centreLights(CountRange counts, RegionMeasure measure) {
  Lights lights = cutLights(counts, measure, LightPlace::Centre, levelCutOf);
  lights.takesLevels = true;
  return lights;
}

// A light for each cluster of cluster(table, request).
template <class Cluster>
Lights clusterLights(CountRange counts, bool isStochastic, const Cluster& cluster) {
  return {.make =
              [=](const Image& latLong, const LightRequest& request) {
                const TexelTable table(latLong, kCoarseCells);
                return MadeLights{cluster(table, request).lights()};
              },
          .counts = counts,
          .isStochastic = isStochastic,
          .keepsEnergy = true,
          .regions =
              [=](const Image& latLong, const LightRequest& request) {
                const TexelTable table(latLong, kCoarseCells);
                return LightRegions{cluster(table, request).partition(latLong), {}};
              }};
}

}  // namespace

Lights medianCutLights(CountRange counts) {
  const auto cut = [](const RegionTable& table, const LightRequest& request) {
    return request.levels ? levelCutOf(table, request) : medianCutRegions(table, *request.count);
  };
  Lights lights = cutLights(counts, RegionMeasure::SolidAngle, LightPlace::Centroid, cut);
  lights.takesLevels = true;
  return lights;
}

Lights centreCutLights(CountRange counts) {
  return centreLights(counts, RegionMeasure::SolidAngle);
}

Lights flatCutLights(CountRange counts) { return centreLights(counts, RegionMeasure::MapArea); }

Lights varianceCutLights(CountRange counts) {
  return cutLights(counts, RegionMeasure::SolidAngle, LightPlace::Centroid,
                   [](const RegionTable& table, const LightRequest& request) {
                     return varianceCutRegions(table, *request.count);
                   });
}

Lights lightGenLights(CountRange counts) {
  return clusterLights(counts, true, [](const TexelTable& table, const LightRequest& request) {
    return lightGenClusters(table, *request.count, request.seed);
  });
}

Lights kolligKellerLights(CountRange counts) {
  return clusterLights(counts, false, [](const TexelTable& table, const LightRequest& request) {
    return kolligKellerClusters(table, *request.count);
  });
}

Lights strataLights(CountRange counts) {
  Lights lights = kolligKellerLights(counts);
  lights.isStochastic = true;
  lights.make = [](const Image& latLong, const LightRequest& request) {
    return MadeLights{kolligKellerStrata(latLong, *request.count, request.seed)};
  };
  return lights;
}

Lights cubeGridLights(CountRange counts) {
  return {.make =
              [](const Image& latLong, const LightRequest& request) {
                return MadeLights{cubeGrid(TexelTable(latLong, kFineCells), *request.count)};
              },
          .counts = counts,
          .keepsEnergy = true,
          .regions =
              [](const Image& latLong, const LightRequest& request) {
                return LightRegions{cubeGridRegions(latLong, *request.count), {}};
              }};
}

Lights penroseLights(CountRange counts) {
  return {.make =
              [](const Image& latLong, const LightRequest& request) {
                return MadeLights{penrose(ImportanceTable(latLong), *request.count, request.seed)};
              },
          .counts = counts,
          .isStochastic = true,
          .keepsEnergy = true,
          .regions =
              [](const Image& latLong, const LightRequest& request) {
                return LightRegions{
                    {}, penroseTiling(ImportanceTable(latLong), *request.count, request.seed)};
              }};
}

}  // namespace chromeball
