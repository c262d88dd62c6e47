// SPDX-License-Identifier: Apache-2.0
// Baked light against closed forms.
#include <gtest/gtest.h>

#include <set>

#include "bake/lightmap.h"
#include "bake/vertex_light.h"
#include "bake_scenes.h"
#include "base/parallel.h"
#include "probe/synth.h"
#include "small_scenes.h"

namespace chromeball::bake_test {
namespace {

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

// A patch in the middle of two nested balls of glass that hardly refract: all light comes 1 m
// through the inner one and 1 m through the outer one.
TEST(Bake, PointsInsideOfGlassReceiveWhatItLetsThrough) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(1))), {-0.01f, 0, 0.01f}, {0.02f, 0, 0},
          {0, 0, -0.02f});
  Material glass;
  glass.metallic = 0, glass.roughness = 0, glass.ior = 1.0001f;
  glass.extended = ExtendedMaterial();
  glass.extended->transmission = 1;
  glass.extended->thinWalled = false;
  for (const float radius : {1.0f, 2.0f}) {
    glass.extended->attenuation = Rgb(0.3f / radius);
    addSphere(scene, addMaterial(scene, glass), vec3(0), radius, 96);
  }
  const double passed = std::exp(-0.3 - 0.15);
  const std::vector<PlacedMesh> patch = {placedMeshes(scene).front()};
  const std::vector<Chart> charts = chartsOf(patch);
  const Atlas atlas = fitAtlas(charts, 4, 1, "test");
  for (const BakedLight what : {BakedLight::Irradiance, BakedLight::Radiance}) {
    const World world(scene, {}, allTables());
    const Probe probe(white());
    const auto lighting = makeStrategy("bsdf", probe, Mis::Balance, "test");
    const std::vector<BakePoint> points = texelPoints(patch, charts, atlas);
    const BakeResult result = bake(world, *lighting, placedMeshes(scene), points,
                                   {.what = what, .samples = 256, .maxDepth = 8}, [](double) {});
    double sum = 0;
    for (const PointResult& point : result.points) sum += double(point.mean().x);
    const double mean = sum / double(result.points.size());
    EXPECT_NEAR(mean, (what == BakedLight::Irradiance ? kPiD : 1) * passed, 0.02 * passed)
        << int(what);
  }
}

// Every heuristic weighs samples in its own way, for the same mean.
TEST(Bake, HeedsTheHeuristic) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 2}, {2, 0, 0}, {0, 0, -2});
  const Image probe = gradientProbe({32, 16}, Rgb(1), {0, 0.6, 0.8});
  std::set<float> firsts;
  std::vector<double> means;
  for (const Mis mis : {Mis::Balance, Mis::Power, Mis::Off}) {
    const Baked baked(scene, probe, "uniform", 32, {.samples = 256, .mis = mis});
    double sum = 0;
    for (const PointResult& point : baked.result.points) sum += double(point.mean().y);
    firsts.insert(baked.result.points.front().mean().y);
    means.push_back(sum / double(baked.points.size()));
  }
  EXPECT_EQ(firsts.size(), 3u);
  EXPECT_NEAR(means[1] / means[0], 1, 2e-3);
  EXPECT_NEAR(means[2] / means[0], 1, 2e-3);
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

TEST(Bake, NothingIsReflectedWithoutBounces) {
  Scene scene;
  Material lamp = lambert(Rgb(0.5f));
  lamp.emission = Rgb(0.25f);
  addSphere(scene, addMaterial(scene, lamp), {0, 0, 0}, -1, 8, false);
  const auto lightAt = [&](BakedLight what) {
    const Baked baked(scene, white(), "bsdf", 64, {.what = what, .samples = 4, .maxDepth = 0});
    return baked.result.points[0].mean();
  };
  EXPECT_EQ(lightAt(BakedLight::Irradiance), Rgb(0));
  EXPECT_EQ(lightAt(BakedLight::Radiance), Rgb(0.25f));
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
    const ThreadLimit limit(threads);
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

  for (const float scale : {0x1p-100f, 0x1p-50f, 0x1p70f, 0x1p100f}) {
    BakeResult scaled = baked.result;
    for (PointResult& point : scaled.points)
      for (Rgb& half : point.halves) half *= scale;
    const std::vector<Rgb> found = filteredLight(baked.points, scaled, 64);
    for (size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], scale * filtered[i]) << scale;
  }
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
}  // namespace chromeball::bake_test
