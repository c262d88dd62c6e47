// SPDX-License-Identifier: Apache-2.0
// Properties of each constellation method.
#include <gtest/gtest.h>

#include "constellation_maps.h"
#include "lighting/constellation/median_cut.h"
#include "lighting/constellation/spherical_kmeans.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"

namespace chromeball::constellation_methods_test {
namespace {

double energy(const RegionTable& table, const Region& r) { return table.moment(r).w; }

TEST(Constellation, MedianCutHalvesEnergy) {
  const RegionTable table(noise(96, 48));
  std::vector<Region> before = medianCutRegions(table, 1);
  const auto same = [](const Region& a, const Region& b) {
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
  };
  for (int n = 2; n <= 64; ++n) {
    const std::vector<Region> after = medianCutRegions(table, n);
    ASSERT_EQ(int(after.size()), n);
    // The region with most energy was cut; the parts are at its index and at the end.
    int cut = -1;
    for (int i = 0; i < n - 1; ++i)
      if (!same(before[i], after[i])) {
        EXPECT_EQ(cut, -1);
        cut = i;
      }
    ASSERT_NE(cut, -1);
    const Region &whole = before[cut], &first = after[cut], &second = after.back();
    for (const Region& other : before) EXPECT_GE(energy(table, whole), energy(table, other));
    EXPECT_NEAR(energy(table, first) + energy(table, second), energy(table, whole), 1e-12);
    double line = 0;  // the maximum energy of a column or row beside the cut
    if (first.x1 == second.x0)
      for (const int x : {first.x1 - 1, first.x1})
        line = std::max(line, energy(table, {x, whole.y0, x + 1, whole.y1}));
    else
      for (const int y : {first.y1 - 1, first.y1})
        line = std::max(line, energy(table, {whole.x0, y, whole.x1, y + 1}));
    EXPECT_LE(std::fabs(energy(table, first) - energy(table, second)), line * (1 + 1e-9));
    before = after;
  }
}

TEST(Constellation, VarianceCutSeparatesTwoSuns) {
  Image map = oneHotProbe({64, 32}, 10, 12, Rgb(100));
  map.setRgb(30, 20, Rgb(0, 1, 0));
  const Constellation lights = make("variance-cut", map, 2);
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(std::count_if(lights.begin(), lights.end(),
                          [](const DirectionalLight& l) { return l.irradiance.x == 0; }),
            1);
}

// The objective of K-means: sum of weight (1 - cos to the nearest light).
double objective(const TexelTable& table, const Constellation& lights) {
  double sum = 0;
  for (const TexelSum& cell : table.cells()) {
    double maximum = -cell.weight;
    for (const DirectionalLight& light : lights)
      maximum = std::max(maximum, glm::dot(cell.moment, dvec3(light.direction)));
    sum += cell.weight - maximum;
  }
  return sum;
}

TEST(Constellation, KMeansDescendsAndConverges) {
  const TexelTable table(noise(64, 32), kCoarseCells);
  SphericalKMeans kMeans(table);
  for (int i = 0; i < 40; ++i) kMeans.addCentre(17 * i);
  kMeans.step();
  int steps = 1;
  for (double before = kMeans.objective(); kMeans.step(); ++steps) {
    ASSERT_LT(steps, 200);
    EXPECT_LE(kMeans.objective(), before * (1 + 1e-12));
    before = kMeans.objective();
  }
  EXPECT_GT(steps, 3);
  // The pruned search gives the same result: cells at their nearest centres, centres at centroids.
  EXPECT_NEAR(kMeans.objective(), objective(table, kMeans.lights()), 1e-6 * kMeans.objective());
}

TEST(Constellation, KolligKellerBeatsLightGen) {
  std::vector<Image> maps = realProbes(2);
  maps.push_back(studioProbe({128, 64}));
  for (const Image& map : maps)
    for (const int count : {32, 64}) {
      const TexelTable table(map, 1 << 12);
      EXPECT_LT(objective(table, kolligKellerClusters(table, count).lights()),
                objective(table, lightGenClusters(table, count, 1).lights()));
    }
}

TEST(Constellation, StrataAreTheRegionsOfTheirLights) {
  const Image map = noise(64, 32);
  const Partition partition = kolligKellerRegions(map, 30);
  ASSERT_EQ(partition.regions, 30);
  ASSERT_EQ(partition.label.size(), 64u * 32);
  const Constellation means = make("kollig-keller", map, 30);
  const Constellation strata = make("kollig-keller-strata", map, 30);
  ASSERT_EQ(strata.size(), 30u);
  for (int i = 0; i < 30; ++i) {
    EXPECT_LT(glm::distance(means[i].irradiance, strata[i].irradiance), 1e-5f);
    const dvec2 uv = directionToUv(Mapping::LatLong, strata[i].direction);
    const int x = std::min(int(uv.x * 64), 63), y = std::min(int(uv.y * 32), 31);
    EXPECT_EQ(partition.label[y * 64 + x], i);
  }
}

// The mean direction over seeds is the region's centroid.
TEST(Constellation, StrataSampleByPower) {
  const Image map = noise(16, 8);
  const Constellation means = make("kollig-keller", map, 4);
  std::vector<dvec3> mean(4, dvec3(0));
  const int draws = 2000;
  for (int seed = 0; seed < draws; ++seed) {
    const Constellation lights = make("kollig-keller-strata", map, 4, seed);
    for (int i = 0; i < 4; ++i) mean[i] += dvec3(lights[i].direction) / double(draws);
  }
  for (int i = 0; i < 4; ++i)
    EXPECT_GT(glm::dot(glm::normalize(mean[i]), dvec3(means[i].direction)), std::cos(0.06));
}

// In a map of constant importance, lights are evenly distributed with a minimum distance.
TEST(Constellation, PenroseIsEvenAndSpaced) {
  Image map(512, 256, 3);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 512; ++x)
      map.setRgb(x, y, Rgb(float(1 / std::sin(kPiD * (y + 0.5) / 256))));
  const int count = 2000, columns = 16, rows = 8;
  const Constellation lights = make("penrose", map, count);
  std::vector<int> found(columns * rows);
  std::vector<dvec2> points;
  for (const DirectionalLight& light : lights) {
    const dvec2 uv = directionToUv(Mapping::LatLong, light.direction);
    ++found[std::min(int(uv.y * rows), rows - 1) * columns + std::min(int(uv.x * columns), 15)];
    points.push_back({2 * uv.x, uv.y});
  }
  // Random points would have a standard deviation of 4 around the mean of 15.6.
  double squares = 0;
  for (const int n : found) squares += std::pow(n - double(count) / (columns * rows), 2);
  EXPECT_LT(std::sqrt(squares / (columns * rows)), 2);
  // A hexagonal grid of cell area 2 / count has a minimum distance of 0.034, random points have
  // about 0.0005.
  double minimum = 1;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t j = 0; j < i; ++j) minimum = std::min(minimum, glm::distance(points[i], points[j]));
  EXPECT_GT(minimum, 0.25 * std::sqrt(2.0 / count));
}

// Error measure of Madsen and Laursen: mean |E_lights - E_probe| over normals and channels, divided
// by mean E.
double irradianceError(const Image& map, const Constellation& lights) {
  std::vector<vec3> normals;
  for (int i = 0; i < 300; ++i) {
    const double z = 1 - (2 * i + 1) / 300.0, azimuth = 2.399963229728653 * i;
    const double r = std::sqrt(1 - z * z);
    normals.push_back(vec3(dvec3(r * std::cos(azimuth), z, r * std::sin(azimuth))));
  }
  const std::vector<dvec3> exact = exactIrradiance(map, normals);
  dvec3 error(0), mean(0);
  for (size_t i = 0; i < normals.size(); ++i) {
    dvec3 sum(0);
    for (const DirectionalLight& light : lights)
      sum += dvec3(light.irradiance) * std::max(0.0, double(glm::dot(normals[i], light.direction)));
    error += glm::abs(sum - exact[i]);
    mean += exact[i];
  }
  error /= mean;
  return (error.x + error.y + error.z) / 3;
}

TEST(SlowConstellation, VarianceCutBeatsMedianCut) {
  const std::vector<Image> maps = realProbes(8);
  if (maps.empty()) GTEST_SKIP() << "no shared probes";
  for (const int count : {16, 32, 64}) {
    double median = 0, variance = 0;
    for (const Image& map : maps) {
      median += irradianceError(map, make("median-cut", map, count)) / double(maps.size());
      variance += irradianceError(map, make("variance-cut", map, count)) / double(maps.size());
    }
    EXPECT_LT(variance, 0.8 * median) << count;
    EXPECT_LT(variance, 0.6 / count);
  }
}

}  // namespace
}  // namespace chromeball::constellation_methods_test
