// SPDX-License-Identifier: Apache-2.0
// Transfer at vertices against irradiance in closed form and against path-traced bakes.
#include <gtest/gtest.h>

#include "bake/bake.h"
#include "base/error.h"
#include "base/parallel.h"
#include "probe/irradiance.h"
#include "probe/synth.h"
#include "relight/transfer/transfer_model.h"
#include "small_scenes.h"

namespace chromeball::transfer_test {
namespace {

struct Transferred {
  std::vector<PlacedMesh> meshes;
  std::vector<BakePoint> points;
  LightBasis basis;
  VertexTransfer transfer;

  Transferred(const Scene& scene, const char* name, const TransferSettings& settings)
      : meshes(placedMeshes(scene)), points(vertexPoints(meshes)), basis(name, "test") {
    const World world(scene, {}, allTables());
    transfer = estimateTransfer(world, meshes, points, basis, settings, [](double) {});
  }

  // The irradiance by point, under the `keep` most important coefficients of a probe.
  std::vector<dvec3> irradiance(const Image& probe, size_t keep = SIZE_MAX) const {
    std::vector<Rgb> light = basis.project(probe, {});
    keepMostImportant(basis, keep, light);
    std::vector<dvec3> all;
    for (size_t i = 0; i < points.size(); ++i) {
      dvec3 sum(0);
      for (size_t k = 0; k < light.size(); ++k) sum += dvec3(light[k]) * dvec3(transfer.of(i)[k]);
      all.push_back(kPiD * sum);
    }
    return all;
  }
};

// The normals of a scene's points, on the front.
std::vector<vec3> normalsOf(const std::vector<PlacedMesh>& meshes,
                            const std::vector<BakePoint>& points) {
  std::vector<vec3> normals;
  for (const BakePoint& point : points)
    normals.emplace_back(meshes[size_t(point.instance)].normals[point.triangle]);
  return normals;
}

std::vector<dvec3> bakedIrradiance(const Scene& scene, const Image& probe, int maxDepth) {
  const std::vector<PlacedMesh> meshes = placedMeshes(scene);
  const World world(scene, {}, allTables());
  const Probe light(probe);
  const auto lighting = makeStrategy("importance", light, Mis::Balance, "test");
  const BakeResult result = bake(world, *lighting, meshes, vertexPoints(meshes),
                                 {.samples = 2048, .seed = 7, .maxDepth = maxDepth}, [](double) {});
  std::vector<dvec3> all;
  for (const PointResult& point : result.points) all.push_back(dvec3(point.mean()));
  return all;
}

double relativeRms(const std::vector<dvec3>& part, const std::vector<dvec3>& whole) {
  double differences = 0, squares = 0;
  for (size_t i = 0; i < whole.size(); ++i) {
    differences += glm::dot(part[i] - whole[i], part[i] - whole[i]);
    squares += glm::dot(whole[i], whole[i]);
  }
  return std::sqrt(differences / squares);
}

// Convex, with flat faces: no vertex has a shadow.
Scene convexBody() {
  Scene scene;
  addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0, 0}, 1, 12, false);
  return scene;
}

// The white surface's throughput is 1 for every sample of the cosine, so value k is the mean of
// Y_k: its variance is the variance of Y_k under cos / pi, below 1, over the number of samples.
TEST(Transfer, OpenVerticesHaveTheHarmonicsOfTheCosine) {
  const Scene scene = convexBody();
  const Transferred t(scene, "sh:2", {.samples = 4096, .maxDepth = 1});
  const std::vector<vec3> normals = normalsOf(t.meshes, t.points);
  constexpr double kFactors[] = {1, 2. / 3, 2. / 3, 2. / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
  double squares = 0;
  for (size_t i = 0; i < t.points.size(); ++i) {
    const auto expected = chromeball::shBasis(dvec3(normals[i]));
    for (size_t k = 0; k < kShCount; ++k) {
      const double error = double(t.transfer.of(i)[k].y) - kFactors[k] * expected[k];
      EXPECT_NEAR(error, 0, 5 / std::sqrt(4096.)) << i << " " << k;
      squares += error * error;
    }
  }
  EXPECT_LT(std::sqrt(squares / double(kShCount * t.points.size())), 1 / std::sqrt(4096.));
}

TEST(Transfer, OpenVerticesHaveTheNineTermIrradiance) {
  const Scene scene = convexBody();
  const Transferred t(scene, "sh:2", {.samples = 4096, .maxDepth = 1});
  const Image probe = studioProbe({64, 32});
  const auto expected = shIrradiance(probe, normalsOf(t.meshes, t.points));
  EXPECT_LT(relativeRms(t.irradiance(probe), expected), 0.01);
}

TEST(SlowTransfer, MoreFunctionsComeCloserToTheExactIrradiance) {
  const Scene scene = convexBody();
  const Image probe = threeScenes()[0].probe;
  double before = INFINITY;
  for (const char* name : {"sh:0", "sh:1", "sh:2", "sh:4"}) {
    const Transferred t(scene, name, {.samples = 4096, .maxDepth = 1});
    const auto exact = exactIrradiance(probe, normalsOf(t.meshes, t.points));
    const double error = relativeRms(t.irradiance(probe), exact);
    EXPECT_LT(error, 0.7 * before) << name;
    before = error;
  }
  EXPECT_LT(before, 0.02);
}

// Shadows, and light that surfaces reflect to each other. The gradient is of the first band alone,
// so harmonics have no error but the samples'; the light of the scene's lamp is not.
TEST(SlowTransfer, ShadowedVerticesAreThoseOfABake) {
  const NamedScene scene = threeScenes()[0];
  const Transferred sh(scene.scene, "sh:4", {.samples = 2048, .maxDepth = 4});
  const Image smooth = gradientProbe({32, 16}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
  EXPECT_LT(relativeRms(sh.irradiance(smooth), bakedIrradiance(scene.scene, smooth, 4)), 0.01);
  const auto baked = bakedIrradiance(scene.scene, scene.probe, 4);
  const double ofHarmonics = relativeRms(sh.irradiance(scene.probe), baked);
  EXPECT_GT(ofHarmonics, 0.02);
  EXPECT_LT(ofHarmonics, 0.2);
  const Transferred haar(scene.scene, "haar:16", {.samples = 2048, .maxDepth = 4});
  EXPECT_LT(relativeRms(haar.irradiance(scene.probe), baked), 0.85 * ofHarmonics);
}

// The probe in the middle of each texel's cell: its blurred edges are a small part of 6 x 2 x 2.
TEST(SlowTransfer, AllWaveletsMakeTheLightOfTheCellsMeans) {
  const NamedScene scene = threeScenes()[0];
  const DirectionBasis cells("cube:2", "test");
  const std::vector<Rgb> means = lightWeights(cells, scene.probe, {});
  const ImageSize size{512, 256};
  Image averaged(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      averaged.setRgb(x, y, means[size_t(cells.cell(vec3(texelDirection(size, x, y))))]);
  const Transferred t(scene.scene, "haar:2", {.samples = 2048, .maxDepth = 2});
  const auto baked = bakedIrradiance(scene.scene, averaged, 2);
  EXPECT_LT(relativeRms(t.irradiance(scene.probe), baked), 0.02);
  EXPECT_GT(relativeRms(bakedIrradiance(scene.scene, scene.probe, 2), baked), 0.03);
}

TEST(Transfer, KeepsTheMostImportantCoefficients) {
  const NamedScene scene = threeScenes()[0];
  const Transferred t(scene.scene, "haar:8", {.samples = 256, .maxDepth = 2});
  const auto all = t.irradiance(scene.probe);
  double before = INFINITY;
  for (const size_t keep : {6u, 24u, 96u, 384u}) {
    const double error = relativeRms(t.irradiance(scene.probe, keep), all);
    EXPECT_LT(error, before) << keep;
    before = error;
  }
  EXPECT_EQ(before, 0);
  std::vector<Rgb> light = t.basis.project(scene.probe, {});
  keepMostImportant(t.basis, 10, light);
  EXPECT_EQ(std::ranges::count_if(light, [](const Rgb& c) { return c != Rgb(0); }), 10);
}

TEST(Transfer, LampsAndEmissionAreApart) {
  NamedScene scene = std::move(threeScenes()[2]);
  const Transferred t(scene.scene, "sh:1", {.samples = 1024, .maxDepth = 3});
  ASSERT_EQ(t.transfer.own.size(), t.points.size());
  const Image black = constantProbe({16, 8}, Rgb(0));
  const std::vector<PlacedMesh> meshes = placedMeshes(scene.scene);
  const World world(scene.scene, {}, allTables());
  const Probe probe(black);
  const auto lighting = makeStrategy("bsdf", probe, Mis::Balance, "test");
  const BakeResult baked = bake(world, *lighting, meshes, t.points,
                                {.samples = 1024, .seed = 3, .maxDepth = 3}, [](double) {});
  std::vector<dvec3> own, expected;
  for (size_t i = 0; i < t.points.size(); ++i) {
    own.push_back(kPiD * dvec3(t.transfer.own[i]));
    expected.push_back(dvec3(baked.points[i].mean()));
  }
  EXPECT_LT(relativeRms(own, expected), 0.08);
  EXPECT_TRUE(Transferred(convexBody(), "sh:0", {.samples = 16}).transfer.own.empty());
}

TEST(Transfer, SameBitsForAnyNumberOfThreads) {
  const NamedScene scene = threeScenes()[1];
  const auto valuesOf = [&](size_t threads) {
    const ThreadLimit limit(threads);
    return Transferred(scene.scene, "haar:2", {.samples = 16}).transfer.values;
  };
  EXPECT_EQ(valuesOf(1), valuesOf(3));
}

TEST(Transfer, NamesOfBases) {
  for (const char* good : {"sh:0", "sh:6", "haar:1", "haar:32"})
    EXPECT_EQ(LightBasis(good, "test").name(), good);
  for (const char* bad : {"", "sh", "sh:", "sh:-1", "sh:7", "sh:02", "haar:3", "haar:64", "haar:0",
                          "haar:16x", "cube:2", "sh:4 "})
    EXPECT_THROW(LightBasis(bad, "test"), InputError) << bad;
}

}  // namespace
}  // namespace chromeball::transfer_test
