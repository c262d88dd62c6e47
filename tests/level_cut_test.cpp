// SPDX-License-Identifier: Apache-2.0
// Median cut by levels, the regions of constellations, and their preview.
#include "lighting/constellation/median_cut.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "constellation_maps.h"
#include "lighting/export/light_preview.h"
#include "lighting/fit/light_descent.h"
#include "math/icosphere.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::level_cut_test {
namespace {

// Mean and maximum error after 1 to 7 levels, in percent.
using Errors = std::array<LightError, 7>;

void expectErrors(const Image& map, const char* method, const Errors& expected, double tolerance) {
  const std::vector<vec3> normals = icosphereNormals(4);
  const std::vector<dvec3> exact = exactIrradiance(map, normals);
  for (int levels = 1; levels <= 7; ++levels) {
    const Constellation lights = makeLights(method, map, {.levels = levels}).lights;
    const LightError error = lightError(irradianceOf(lights, Rgb(0), normals), exact);
    EXPECT_NEAR(error.mean / expected[levels - 1].mean, 1, tolerance) << levels << " levels";
    EXPECT_NEAR(error.max / expected[levels - 1].max, 1, tolerance) << levels << " levels";
  }
}

constexpr const char *kCentre = "median-cut-centre", *kFlat = "median-cut-flat";

// The numbers come from an independent implementation.
TEST(SlowLevelCut, CentresInGalileosTombErrAsPublished) {
  const auto map = smallProbe("debevec/galileo_probe.hdr");
  if (!map) GTEST_SKIP() << "no Galileo probe";
  expectErrors(*map, kCentre,
               {{{63.5, 188},
                 {30.9, 84},
                 {26.5, 95.5},
                 {15.9, 60.6},
                 {8.8, 34.5},
                 {3.77, 14.8},
                 {1.38, 5.84}}},
               0.05);
  // "The average error is actually around 25 percent, and the maximum error is more than 75
  // percent" (Madsen and Laursen 2007, Fig. 2, eight lights).
  expectErrors(*map, kFlat,
               {{{63.5, 188},
                 {34.1, 101},
                 {23.1, 74.7},
                 {13.6, 36.3},
                 {9.35, 27.6},
                 {3.35, 11.3},
                 {1.5, 5.48}}},
               0.05);
}

TEST(SlowLevelCut, CentresInStPetersErrAsInAnotherImplementation) {
  const auto map = smallProbe("debevec/stpeters_cross.hdr");
  if (!map) GTEST_SKIP() << "no probe of St Peter's";
  expectErrors(*map, kCentre,
               {{{58.3, 172},
                 {26.1, 92.9},
                 {17.1, 42.2},
                 {8.98, 24.8},
                 {4.72, 19.5},
                 {1.98, 7.77},
                 {0.867, 3.3}}},
               0.05);
}

// Under a sky without ground, centres are far from the sun until its region is small. The other
// implementation finds 0.555 at last: its horizons do not cut texels, and the sun's is large.
TEST(SlowLevelCut, CentresAndCentroidsUnderASkyWithoutGround) {
  auto map = smallProbe("polyhaven/qwantani_afternoon_puresky_1k.hdr");
  if (!map) GTEST_SKIP() << "no sky";
  std::fill(map->texels.begin() + map->texels.size() / 2, map->texels.end(), 0.0f);
  expectErrors(*map, kCentre,
               {{{138, 364},
                 {63.1, 226},
                 {42.8, 139},
                 {5.07, 16.5},
                 {2.97, 11.3},
                 {1.59, 6.11},
                 {0.661, 2.59}}},
               0.05);
  expectErrors(*map, "median-cut",
               {{{9.05, 26.3},
                 {5.63, 15.7},
                 {1.93, 5.39},
                 {1.51, 3.93},
                 {0.491, 1.83},
                 {0.322, 1.32},
                 {0.152, 0.6}}},
               0.05);
}

TEST(LevelCut, EachLevelDoublesTheRegions) {
  const Image map = noise(128, 64);
  for (const RegionMeasure measure : {RegionMeasure::SolidAngle, RegionMeasure::MapArea}) {
    const RegionTable table(map, measure);
    const double whole = table.moment({0, 0, 128, 64}).w;
    for (int levels = 1; levels <= 6; ++levels) {
      const auto regions = levelCutRegions(table, levels, 4096);
      ASSERT_EQ(int(regions.size()), 1 << levels);
      for (const Region& r : regions)
        EXPECT_NEAR(table.moment(r).w / whole * (1 << levels), 1, 0.2);
    }
  }
}

// A flat picture of equal radiance is cut in the middle of its columns, then of its rows, in
// whatever measure; only the measure of the map cuts a quarter across rows at the same height.
TEST(LevelCut, MeasuresDifferNearThePoles) {
  Image map = constantProbe({64, 32}, Rgb(1));
  const auto rows = [&](RegionMeasure measure) {
    std::vector<int> tops;
    for (const Region& r : levelCutRegions(RegionTable(map, measure), 4, 64)) tops.push_back(r.y0);
    std::sort(tops.begin(), tops.end());
    tops.erase(std::unique(tops.begin(), tops.end()), tops.end());
    return tops;
  };
  // Quarters of 32 rows of equal area; of equal solid angle: above and below the equator, half of
  // it is between 30 degrees and the pole (10 2/3 rows).
  EXPECT_EQ(rows(RegionMeasure::MapArea), (std::vector<int>{0, 8, 16, 24}));
  EXPECT_EQ(rows(RegionMeasure::SolidAngle), (std::vector<int>{0, 11, 16, 21}));
}

// A bright texel in the upper half: the black rest stays in the region, so its centre is the map's.
TEST(LevelCut, BlackMarginsMoveCentresButNotCentroids) {
  Image map(64, 32, 3);
  map.setRgb(10, 4, Rgb(1));
  map.setRgb(50, 4, Rgb(1));
  const Constellation centres = makeLights(kCentre, map, {.levels = 1}).lights;
  const Constellation centroids = makeLights("median-cut", map, {.levels = 1}).lights;
  ASSERT_EQ(centres.size(), 2u);
  ASSERT_EQ(centroids.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(centres[i].direction.y, 0, 1e-6);
    EXPECT_NEAR(centroids[i].direction.y, std::cos(kPi * 4.5f / 32), 1e-6);
  }
}

// Methods of one light per region: its irradiance is the region's radiance x solid angle.
TEST(LightRegions, EnergyOfEachRegionIsThatOfItsLight) {
  const Image map = noise(96, 48);
  for (const std::string_view name :
       {"median-cut", "median-cut-centre", "median-cut-flat", "variance-cut", "lightgen",
        "kollig-keller", "kollig-keller-strata", "cube-grid"}) {
    SCOPED_TRACE(name);
    const LightRequest request{.count = countFor(name, 24), .seed = 3};
    const Constellation lights = makeLights(name, map, request).lights;
    const Partition partition = lightMethod(name, "test").lights.regions(map, request).partition;
    ASSERT_EQ(partition.label.size(), 96u * 48);
    std::vector<dvec3> power(partition.regions, dvec3(0));
    for (size_t i = 0; i < partition.label.size(); ++i) {
      ASSERT_LT(partition.label[i], partition.regions);
      const int x = int(i % 96), y = int(i / 96);
      power[partition.label[i]] += dvec3(map.rgb(x, y)) * texelSolidAngle(y, 96, 48);
    }
    ASSERT_EQ(lights.size(), power.size());
    for (size_t i = 0; i < power.size(); ++i)
      EXPECT_LT(glm::distance(power[i], dvec3(lights[i].irradiance)), 1e-5 * power[i].y) << i;
  }
}

// Corners become lights, so each light is at the end of some line.
TEST(LightRegions, LightsOfPenroseAreCornersOfTheTiling) {
  const Image map = noise(64, 32);
  const LightRequest request{.count = 60, .seed = 2};
  const auto lines = lightMethod("penrose", "test").lights.regions(map, request).tiling;
  for (const DirectionalLight& light : makeLights("penrose", map, request).lights) {
    const dvec2 uv = directionToUv(Mapping::LatLong, light.direction);
    double nearest = 1;
    for (const MapLine& line : lines)
      nearest = std::min({nearest, glm::distance(uv, line.from), glm::distance(uv, line.to)});
    EXPECT_LT(nearest, 1e-5);
  }
}

// Two regions, left and right: a column of white pixels in the middle and at the seam, between
// black ones.
TEST(LightRegions, PreviewOutlinesRegionsAndMarksLightsInRed) {
  const Image map = constantProbe({32, 16}, Rgb(0.2f));
  Partition halves{2, std::vector<uint16_t>(32 * 16)};
  for (size_t i = 0; i < halves.label.size(); ++i) halves.label[i] = i % 32 >= 16;
  const Constellation lights{{vec3(0, 0, -1), Rgb(1), 0}};
  const Image preview = lightPreview(map, lights, {halves, {}});
  for (const int y : {0, 100, 511}) {
    EXPECT_EQ(preview.rgb(511, y), Rgb(1));
    EXPECT_EQ(preview.rgb(1023, y), Rgb(1));
    for (const int x : {0, 510, 512, 1022}) EXPECT_EQ(preview.rgb(x, y), Rgb(0)) << x;
    EXPECT_EQ(preview.rgb(300, y), preview.rgb(200, y));
    EXPECT_GT(preview.rgb(300, y).x, 0);
  }
  EXPECT_EQ(preview.rgb(512, 256), Rgb(1, 0, 0));
  // Without regions the dot is white.
  EXPECT_EQ(lightPreview(map, lights).rgb(512, 256), Rgb(1));
}

TEST(LightRegions, OfABlackMap) {
  const Image map(16, 8, 3);
  for (const LightingMethod& method : lightingMethods()) {
    if (!method.lights.regions) continue;
    const LightRegions regions = method.lights.regions(map, {.count = 4});
    EXPECT_NO_THROW(lightPreview(map, {}, regions)) << method.name;
  }
}

}  // namespace
}  // namespace chromeball::level_cut_test
