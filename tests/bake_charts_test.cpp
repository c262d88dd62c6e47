// SPDX-License-Identifier: Apache-2.0
// Charts, their atlas and the points of its texels.
#include <gtest/gtest.h>

#include "bake/bake_points.h"
#include "bake_scenes.h"

namespace chromeball::bake_charts_test {
namespace {

TEST(BakeCharts, ChartsHoldEveryTriangleOnceAndDoNotOverlap) {
  const Scene scene = varied();
  for (const PlacedMesh& placed : placedMeshes(scene)) {
    std::vector<int> uses(placed.triangleCount());
    for (const Chart& chart : makeCharts(placed)) {
      EXPECT_GE(chart.size.x, chart.size.y);
      std::vector<FlatTriangle> flat;
      for (const uint32_t triangle : chart.triangles) {
        ++uses[triangle];
        flat.push_back(chart.project(placed, triangle));
        for (const glm::dvec2& p : flat.back()) {
          EXPECT_GE(std::min(p.x, p.y), -1e-9);
          EXPECT_LE(p.x, chart.size.x + 1e-9);
          EXPECT_LE(p.y, chart.size.y + 1e-9);
        }
      }
      for (size_t i = 0; i < flat.size(); ++i)
        for (size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(flat[i], flat[j], 1e-4));
    }
    for (size_t i = 0; i < uses.size(); ++i) EXPECT_EQ(uses[i], placed.hasArea(uint32_t(i)));
  }
}

TEST(BakeCharts, ChartsEndAtCreases) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  addBox(scene, matte, {0, 0, 0}, {1, 2, 3});
  EXPECT_EQ(makeCharts(PlacedMesh(scene, 0)).size(), 6u);
  addMesh(scene, matte, spiral());  // winds twice; charts grow in both directions
  const size_t turns = makeCharts(PlacedMesh(scene, 1)).size();
  EXPECT_GE(turns, 2u);
  EXPECT_LE(turns, 3u);
  const PlacedMesh box(scene, 0), ramp(scene, 1);
  EXPECT_EQ(std::ranges::count(box.isClosed, 1), 12);
  EXPECT_EQ(std::ranges::count(ramp.isClosed, 1), 0);
}

TEST(BakeCharts, PlacesOfTheAtlasDoNotOverlapAndHavePadding) {
  const Scene scene = varied();
  const std::vector<PlacedMesh> meshes = placedMeshes(scene);
  const std::vector<Chart> charts = chartsOf(meshes);
  for (const int padding : {0, 3}) {
    const Atlas atlas = fitAtlas(charts, 256, padding, "test");
    std::vector<int> owner(256 * 256, -1);
    for (size_t i = 0; i < atlas.places.size(); ++i) {
      const AtlasPlace& place = atlas.places[i];
      for (int y = place.y; y < place.y + place.height; ++y)
        for (int x = place.x; x < place.x + place.width; ++x) {
          ASSERT_TRUE(x >= 0 && y >= 0 && x < 256 && y < 256);
          ASSERT_EQ(owner[size_t(y) * 256 + size_t(x)], -1);
          owner[size_t(y) * 256 + size_t(x)] = int(i);
        }
    }
    for (const BakePoint& p : texelPoints(meshes, charts, atlas)) {
      EXPECT_EQ(owner[p.y * 256 + p.x], p.chart);
      // The padding stays free; points reach half a diagonal beyond a chart's edge.
      const AtlasPlace& place = atlas.places[size_t(p.chart)];
      EXPECT_GE(int(p.x), place.x + std::max(padding - 1, 0));
      EXPECT_LT(int(p.x), place.x + place.width - std::max(padding - 1, 0));
    }
  }
}

// Bilinear filtering at any point of a chart reads texels that were baked.
TEST(BakeCharts, EveryTexelThatAChartTouchesHasAPoint) {
  const Scene scene = varied();
  const std::vector<PlacedMesh> meshes = placedMeshes(scene);
  const std::vector<Chart> charts = chartsOf(meshes);
  const Atlas atlas = fitAtlas(charts, 256, 2, "test");
  std::vector<uint8_t> isBaked(256 * 256);
  for (const BakePoint& p : texelPoints(meshes, charts, atlas)) isBaked[p.y * 256 + p.x] = 1;
  for (size_t i = 0; i < charts.size(); ++i)
    for (const uint32_t triangle : charts[i].triangles) {
      const FlatTriangle flat = charts[i].project(meshes[size_t(charts[i].instance)], triangle);
      for (int k = 0; k < 36; ++k) {
        const double b = (k % 6) / 5.0, c = (1 - b) * (k / 6) / 5.0;
        const glm::dvec2 at = atlas.toPage(i, (1 - b - c) * flat[0] + b * flat[1] + c * flat[2]);
        EXPECT_TRUE(isBaked[size_t(at.y) * 256 + size_t(at.x)]);
      }
    }
}

}  // namespace
}  // namespace chromeball::bake_charts_test
