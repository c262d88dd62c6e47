// SPDX-License-Identifier: Apache-2.0
// Charts, their atlas, and baked light against closed forms.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "bake/fill_page.h"
#include "bake/lightmap.h"
#include "bake/texel_filter.h"
#include "bake/vertex_light.h"
#include "probe/synth.h"
#include "small_scenes.h"

namespace chromeball {
namespace {

std::vector<Chart> chartsOf(const std::vector<PlacedMesh>& meshes) {
  std::vector<Chart> charts;
  for (const PlacedMesh& placed : meshes)
    for (Chart& chart : makeCharts(placed)) charts.push_back(std::move(chart));
  return charts;
}

// A closed box, whose faces look outwards.
void addBox(Scene& scene, int material, vec3 low, vec3 high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  addMesh(scene, material, std::move(mesh));
}

// A ramp that winds twice around an axis: above itself, and nearly flat.
Mesh spiral() {
  Mesh mesh;
  constexpr int kSteps = 64;
  for (int i = 0; i <= kSteps; ++i) {
    const float phi = 4 * kPi * float(i) / kSteps, height = 0.01f * float(i);
    for (const float radius : {2.0f, 1.0f})
      mesh.positions.push_back({radius * std::cos(phi), height, -radius * std::sin(phi)});
  }
  for (uint32_t i = 0; i < 2 * kSteps; i += 2) {
    mesh.triangles.push_back({i, i + 2, i + 1});
    mesh.triangles.push_back({i + 1, i + 2, i + 3});
  }
  return mesh;
}

Scene varied() {
  Scene scene = threeScenes()[0].scene;
  addBox(scene, 0, {1, 0, 1}, {2, 1, 2});
  addMesh(scene, 0, spiral());
  Instance mirrored{int(scene.meshes.size()) - 1, 0, 0, {}};
  mirrored.toWorld = Transform{glm::mat3(-1, 0, 0, 0, 2, 0, 0, 0, 1), vec3(9, 0, 0)};
  scene.instances.push_back(mirrored);
  return scene;
}

struct Baked {
  std::vector<PlacedMesh> meshes;
  std::vector<Chart> charts;
  Atlas atlas;
  std::vector<BakePoint> points;
  BakeResult result;

  Baked(const Scene& scene, const Image& probe, const char* strategy, int size,
        const BakeSettings& settings)
      : meshes(placedMeshes(scene)),
        charts(chartsOf(meshes)),
        atlas(fitAtlas(charts, size, 2, "test")),
        points(texelPoints(meshes, charts, atlas)) {
    const World world(scene, {}, allTables());
    const Probe light(probe);
    const auto lighting = makeStrategy(strategy, light, Mis::Balance, "test");
    result = bake(world, *lighting, meshes, points, settings, [](double) {});
  }
};

Image white() { return constantProbe({16, 8}, Rgb(1)); }

TEST(Bake, ChartsHoldEveryTriangleOnceAndDoNotOverlap) {
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

TEST(Bake, ChartsEndAtCreases) {
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

TEST(Bake, PlacesOfTheAtlasDoNotOverlapAndHavePadding) {
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
      // The padding is free; with the reach of half a diagonal beyond a chart's edge.
      const AtlasPlace& place = atlas.places[size_t(p.chart)];
      EXPECT_GE(int(p.x), place.x + std::max(padding - 1, 0));
      EXPECT_LT(int(p.x), place.x + place.width - std::max(padding - 1, 0));
    }
  }
}

// Bilinear filtering at any point of a chart reads texels that were baked.
TEST(Bake, EveryTexelThatAChartTouchesHasAPoint) {
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

// Every sample of an open plane under a constant probe is pi, with directions by the BSDF.
TEST(Bake, FurnaceOfAnOpenPlane) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 2}, {2, 0, 0}, {0, 0, -2});
  const Baked exact(scene, white(), "bsdf", 32, {.samples = 16});
  ASSERT_GT(exact.points.size(), 500u);
  for (const PointResult& point : exact.result.points) EXPECT_NEAR(point.mean().x, kPi, 4e-6f);
  const Baked sampled(scene, white(), "importance", 32, {.samples = 256});
  double sum = 0;
  for (const PointResult& point : sampled.result.points) sum += double(point.mean().y);
  EXPECT_NEAR(sum / double(sampled.points.size()), kPiD, 1e-3 * kPiD);
  EXPECT_EQ(sampled.result.invalid.total(), 0u);
  const Baked occlusion(scene, white(), "bsdf", 32,
                        {.what = BakedLight::AmbientOcclusion, .samples = 16});
  for (const PointResult& point : occlusion.result.points) EXPECT_EQ(point.mean(), Rgb(1));
  const Baked radiance(scene, white(), "bsdf", 32, {.what = BakedLight::Radiance, .samples = 16});
  for (const PointResult& point : radiance.result.points) EXPECT_NEAR(point.mean().z, 0.5f, 1e-6f);
}

// Inside a closed white sphere of albedo a with nothing outside, lit by its own emission e: the
// irradiance is pi e (1 + a + a^2 + ...) up to the depth.
TEST(Bake, EnergyInAClosedSphere) {
  Scene scene;
  Material lamp = lambert(Rgb(0.5f));
  lamp.emission = Rgb(1);
  addSphere(scene, addMaterial(scene, lamp), {0, 0, 0}, -1, 8, false);
  const Baked baked(scene, white(), "bsdf", 64, {.samples = 64, .maxDepth = 3});
  double sum = 0;
  size_t buried = 0;
  for (const PointResult& point : baked.result.points)
    sum += double(point.mean().x), buried += point.buried;
  EXPECT_EQ(buried, 0u);
  EXPECT_NEAR(sum / double(baked.points.size()), kPiD * 1.75, 0.02 * kPiD);
}

TEST(Bake, OcclusionAtTheFootOfAWall) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, matte, {0, 0, 0.5f}, {0.01f, 0, 0}, {0, 0, -1});
  addQuad(scene, matte, {0, 0, 1000}, {0, 0, -2000}, {0, 1000, 0});
  const std::vector<PlacedMesh> meshes = placedMeshes(scene);
  const World world(scene, {}, allTables());
  const Probe probe(white());
  const auto lighting = makeStrategy("bsdf", probe, Mis::Balance, "test");
  const std::vector<BakePoint> points{{3, 4, 0, 0, 0, vec2(0.3f, 0.3f), 0.001f}};
  const BakeResult result =
      bake(world, *lighting, meshes, points,
           {.what = BakedLight::AmbientOcclusion, .samples = 4096}, [](double) {});
  EXPECT_NEAR(result.points[0].mean().x, 0.5f, 3e-3f);
}

// A floor at distance d from the middle of a side of a box, h = 1 high and 2 b = 2 wide. The side
// hides this part of the cosine-weighted sky (Hamilton and Morgan 1952):
//   (atan(b / d) - d / sqrt(d^2 + h^2) atan(b / sqrt(d^2 + h^2))) / pi
TEST(Bake, OcclusionOfABoxOnAFloor) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, matte, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8});
  addBox(scene, matte, {-1, 0, -1}, {1, 1, 1});
  const Baked baked(scene, white(), "bsdf", 128,
                    {.what = BakedLight::AmbientOcclusion, .samples = 256});
  int beside = 0, below = 0;
  for (size_t i = 0; i < baked.points.size(); ++i) {
    const BakePoint& p = baked.points[i];
    if (p.instance != 0) continue;
    const Triangle& t = scene.meshes[0].triangles[p.triangle];
    const auto& at = scene.meshes[0].positions;
    const vec3 position = (1 - p.barycentric.x - p.barycentric.y) * at[t.x] +
                          p.barycentric.x * at[t.y] + p.barycentric.y * at[t.z];
    const bool isBelow = std::max(std::fabs(position.x), std::fabs(position.z)) < 0.99f;
    below += isBelow;
    EXPECT_TRUE(!isBelow || baked.result.points[i].buried) << position.x << " " << position.z;
    const double d = double(position.x) - 1, c = std::fabs(double(position.z));
    if (d < 0.05 || c > 1e-6 + 0.06) continue;
    const double slant = std::sqrt(d * d + 1);
    const double hidden = (std::atan(1 / d) - d / slant * std::atan(1 / slant)) / kPiD;
    EXPECT_NEAR(double(baked.result.points[i].mean().x), 1 - hidden, 0.03) << d;
    ++beside;
  }
  EXPECT_GT(beside, 10);
  EXPECT_GT(below, 20);
}

TEST(Bake, SameBitsForAnyNumberOfThreads) {
  const NamedScene scene = threeScenes()[0];
  const auto bakedBy = [&](size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const Baked baked(scene.scene, scene.probe, "importance", 48, {.samples = 4});
    return filteredLight(baked.points, baked.result, 48);
  };
  EXPECT_EQ(bakedBy(1), bakedBy(3));
}

TEST(Bake, FilterKeepsConstantLightAndReducesNoise) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 2}, {2, 0, 0}, {0, 0, -2});
  Baked baked(scene, white(), "bsdf", 64, {.samples = 2});
  const Rgb constant(0.1f, 0.7f, 1.3f);
  for (PointResult& point : baked.result.points) point.halves = {constant, constant};
  for (const Rgb& light : filteredLight(baked.points, baked.result, 64)) EXPECT_EQ(light, constant);

  // Light with a gradient and an edge, and noise of 20%.
  const auto truth = [](const BakePoint& p) {
    return Rgb(float(p.x) / 64 + (p.y > 30 ? 1.0f : 0.2f));
  };
  double before = 0, after = 0;
  for (size_t i = 0; i < baked.points.size(); ++i)
    for (uint64_t half = 0; half < 2; ++half) {
      const float noise = toUnit(uint32_t(hash(i, half))) + toUnit(uint32_t(hash(i, half + 2))) - 1;
      baked.result.points[i].halves[half] = truth(baked.points[i]) * (1 + 0.5f * noise);
    }
  const std::vector<Rgb> filtered = filteredLight(baked.points, baked.result, 64);
  for (size_t i = 0; i < filtered.size(); ++i) {
    const double t = double(truth(baked.points[i]).x);
    const auto relative = [&](double x) { return (x - t) * (x - t) / (t * t + 0.01); };
    before += relative(double(baked.result.points[i].mean().x));
    after += relative(double(filtered[i].x));
  }
  RecordProperty("relMSE ratio", std::to_string(before / after));
  EXPECT_LT(after, 0.25 * before);
}

TEST(Bake, FillReachesThePaddingAndBuriedTexels) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 2}, {2, 0, 0}, {0, 0, -2});
  const std::vector<Chart> charts = chartsOf(placedMeshes(scene));
  const Atlas atlas = fitAtlas(charts, 32, 4, "test");
  Image page(32, 32, 3);
  std::vector<uint8_t> isBaked(32 * 32);
  for (int y = 8; y < 20; ++y)
    for (int x = 8; x < 20; ++x) {
      if (x > 11 && x < 16 && y > 11 && y < 16) continue;
      page.setRgb(x, y, Rgb(2));
      isBaked[size_t(y) * 32 + size_t(x)] = 1;
    }
  fillPage(page, isBaked, atlas);
  for (const float texel : page.texels) EXPECT_EQ(texel, 2);
}

TEST(Bake, VerticesTakeTheMeanOfNeighboursInsideOfBodies) {
  Scene scene;
  const int matte = addMaterial(scene, lambert(Rgb(0.5f)));
  Mesh fan;  // its middle is inside the box
  fan.positions.push_back({0, 0.5f, 0});
  for (int i = 0; i < 8; ++i)
    fan.positions.push_back(
        {3 * std::cos(kPi * float(i) / 4), 0.5f, -3 * std::sin(kPi * float(i) / 4)});
  for (uint32_t i = 0; i < 8; ++i) fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % 8});
  addMesh(scene, matte, std::move(fan));
  addBox(scene, matte, {-1, 0, -1}, {1, 1, 1});
  const std::vector<PlacedMesh> meshes = placedMeshes(scene);
  const World world(scene, {}, allTables());
  const Probe probe(white());
  const auto lighting = makeStrategy("bsdf", probe, Mis::Balance, "test");
  const std::vector<BakePoint> points = vertexPoints(meshes);
  ASSERT_EQ(points.size(), 9u + 8u);
  const BakeResult result = bake(world, *lighting, meshes, points, {.samples = 64}, [](double) {});
  EXPECT_TRUE(result.points[0].buried);
  const PathTracer tracer(world, *lighting, {});
  const PointLight light(tracer, BakedLight::Irradiance, INFINITY);
  const auto geometry = colouredGeometry(light, meshes, points, result);
  ASSERT_EQ(geometry.size(), 2u);
  float mean = 0;
  for (int i = 1; i < 9; ++i) mean += geometry[0].colors[size_t(i)].x / 8;
  EXPECT_NEAR(geometry[0].colors[0].x, mean, 1e-5f);
  EXPECT_GT(mean, 0.7f);
}

}  // namespace
}  // namespace chromeball
