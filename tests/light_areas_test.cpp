// SPDX-License-Identifier: Apache-2.0
// The shapes of area lights: regions of a map, and discs.
#include <gtest/gtest.h>

#include "lighting/area_lights.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/spherical_kmeans.h"
#include "probe/mapping.h"
#include "sphere_test.h"

namespace chromeball::light_areas_test {
namespace {

// Sums over the texels of a map for the lights, with regions of any shape: sum of radiance x solid
// angle, and sum of density x solid angle, which is 1 for each region.
void expectEnergyAndSolidAngles(const Image& map, const RegionAreas& areas) {
  dvec3 energy(0), power(0);
  double regions = 0, solidAngle = 0;
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) {
      const double texel = texelSolidAngle(y, map.width, map.height);
      const auto found = areas.at(vec3(texelDirection({map.width, map.height}, x, y)));
      energy += texel * dvec3(found.radiance);
      regions += texel * found.density;
    }
  for (const AreaLight& light : areas.lights()) {
    power += dvec3(light.power);
    solidAngle += light.solidAngle;
  }
  const dvec3 expected = 4 * kPiD * meanRadiance(map);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(energy[k] / expected[k], 1, 1e-5);
    EXPECT_NEAR(power[k] / expected[k], 1, 1e-5);
  }
  EXPECT_NEAR(regions / double(areas.lights().size()), 1, 1e-5);
  EXPECT_NEAR(solidAngle, 4 * kPiD, 1e-9);
}

Image noisy(int width, int height) {
  Image map(width, height, 3);
  for (size_t i = 0; i < map.texels.size(); ++i)
    map.texels[i] = 0.01f + std::pow(random1(int(i), 0), 4.0f);
  return map;
}

Partition medianCut(const Image& map, int count) {
  const RegionTable table(map);
  return table.partition(map, medianCutRegions(table, count));
}

// 301 x 151 texels make blocks of 2 x 2 for kollig-keller, with halves at the right and below.
TEST(RegionAreas, KeepTheEnergyAndTheSphere) {
  const Image map = noisy(301, 151);
  expectEnergyAndSolidAngles(map, {map, medianCut(map, 100), 0});
  expectEnergyAndSolidAngles(map, {map, kolligKellerRegions(map, 30), 0});
}

TEST(SlowRegionAreas, KeepTheEnergyOfPartialRowsAndColumns) {
  const Image map = noisy(2051, 1031);  // blocks of 2 x 2 for median cut too
  ASSERT_EQ(TexelTable(map, kFineCells).block(), 2);
  expectEnergyAndSolidAngles(map, {map, medianCut(map, 64), 0});
}

// The table of discs near a direction leaves none out.
TEST(DiscAreas, EveryDiscAroundADirectionIsFound) {
  std::vector<AreaLight> lights;
  for (int i = 0; i < 400; ++i)
    lights.push_back({squareToUniformSphere(random2(i, 0)), Rgb(random1(i, 2)),
                      4 * kPiD * std::pow(random1(i, 3), 8.0) + 1e-6});
  lights.push_back({{0, 1, 0}, Rgb(1), 0.01});
  lights.push_back({{0, 0, 1}, Rgb(1), 4 * kPiD});
  const DiscAreas areas(lights);
  for (int i = 0; i < 20000; ++i) {
    vec3 wi = squareToUniformSphere(random2(i, 4));
    if (i % 2) wi = areas.sample(size_t(i) % lights.size(), random1(i, 6), random1(i, 7)).direction;
    double density = 0;
    for (const AreaLight& light : lights) {
      const vec3 chord = wi - light.direction;
      if (glm::dot(chord, chord) <= float(light.solidAngle / kPiD)) density += 1 / light.solidAngle;
    }
    ASSERT_NEAR(areas.at(wi).density, density, 1e-5 * density) << i;
  }
}

// The radiance of each region of Kollig and Keller is the mean RGB over its solid angle.
TEST(RegionAreas, HaveTheMeanColourOfTheRegionsOfKolligAndKeller) {
  const Image sky = noisy(32, 16);
  const Partition partition = kolligKellerRegions(sky, 9);
  const RegionAreas areas(sky, partition, 0);
  std::vector<dvec3> sum(9, dvec3(0));
  std::vector<double> solidAngle(9);
  const auto region = [&](int x, int y) { return partition.label[size_t(y) * sky.width + x]; };
  for (int y = 0; y < sky.height; ++y)
    for (int x = 0; x < sky.width; ++x) {
      const double texel = texelSolidAngle(y, sky.width, sky.height);
      sum[region(x, y)] += texel * dvec3(sky.rgb(x, y));
      solidAngle[region(x, y)] += texel;
    }
  for (int y = 0; y < sky.height; ++y)
    for (int x = 0; x < sky.width; ++x) {
      const auto found = areas.at(vec3(texelDirection({sky.width, sky.height}, x, y)));
      const int i = region(x, y);
      EXPECT_NEAR(found.density * solidAngle[i], 1, 1e-5);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(found.radiance[k] * solidAngle[i] / sum[i][k], 1, 1e-5);
    }
}

}  // namespace
}  // namespace chromeball::light_areas_test
