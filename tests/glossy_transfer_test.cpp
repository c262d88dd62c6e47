// SPDX-License-Identifier: Apache-2.0
// Matrices of glossy transfer: against diffuse transfer and path-traced radiance, and in a file.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "relight/transfer/clustered_pca.h"
#include "relight/transfer/glossy_model.h"
#include "small_scenes.h"

namespace chromeball::glossy_transfer_test {
namespace {

struct Estimated {
  std::vector<PlacedMesh> meshes;
  std::vector<BakePoint> points;
  LightBasis basis{"sh:2", "test"};
  World world;
  TransferSettings settings;

  Estimated(const Scene& scene, const TransferSettings& given)
      : meshes(placedMeshes(scene)),
        points(vertexPoints(meshes)),
        world(scene, {}, allTables()),
        settings(given) {}

  GlossyTransfer glossy() const {
    return estimateGlossyTransfer(world, meshes, points, basis, settings, [](double) {});
  }
  VertexTransfer diffuse() const {
    return estimateTransfer(world, meshes, points, basis, settings, [](double) {});
  }
};

Scene sphereOf(const Material& material) {
  Scene scene;
  addSphere(scene, addMaterial(scene, material), {0, 0, 0}, 1, 8, false);
  return scene;
}

TEST(ViewGrid, InterpolatesBetweenItsDirections) {
  for (int node = 0; node < ViewGrid::kCount; ++node) {
    const vec3 direction = ViewGrid::direction(node);
    EXPECT_GT(direction.z, 0);
    const auto [nodes, weights] = ViewGrid::at(direction);
    float own = 0, sum = 0;
    for (size_t i = 0; i < 4; ++i) {
      sum += weights[i];
      if (nodes[i] == node) own += weights[i];
    }
    EXPECT_NEAR(own, 1, 1e-5f) << node;
    EXPECT_NEAR(sum, 1, 1e-6f);
  }
  for (const vec3& direction : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1), vec3(0, 0, 1),
                                vec3(0.6f, 0.8f, 0), vec3(NAN, NAN, NAN)})
    for (const int node : ViewGrid::at(direction).nodes) {
      EXPECT_GE(node, 0);
      EXPECT_LT(node, ViewGrid::kCount);
    }
}

// A Lambertian surface has the same radiance towards each node: albedo times a white surface's.
// Each is a mean of `samples` values of Y_k, of a variance below 1.
TEST(GlossyTransfer, LambertianSurfacesAreDiffuse) {
  const Scene scene = sphereOf(lambert(Rgb(0.5f)));
  const Estimated e(scene, {.samples = 1024, .maxDepth = 2});
  const GlossyTransfer glossy = e.glossy();
  const VertexTransfer diffuse = e.diffuse();
  ASSERT_EQ(glossy.matrices.count, ViewGrid::kCount * 10u);
  for (size_t i = 0; i < e.points.size(); ++i)
    for (size_t node = 0; node < ViewGrid::kCount; ++node)
      for (size_t k = 0; k < 9; ++k)
        EXPECT_NEAR(glossy.matrices.of(i)[node * 10 + k].x, 0.5f * diffuse.of(i)[k].x, 5 / 32.);
}

// Under constant light, coefficients (sqrt(4 pi), 0, ...), a metal loses little: its radiance is
// about its colour; and the gradient's light turns brighter towards its mirror direction.
TEST(GlossyTransfer, MetalsShowTheirMirrorDirection) {
  Material metal;
  metal.baseColor = {0.9f, 0.9f, 0.9f, 1};
  metal.roughness = 0.4f;
  const Scene scene = sphereOf(metal);
  const Estimated e(scene, {.samples = 256, .maxDepth = 2});
  const GlossyTransfer glossy = e.glossy();
  double same = 0, opposite = 0;
  for (size_t i = 0; i < e.points.size(); ++i) {
    const Frame frame(glossy.normals[i]);
    for (int node = 0; node < ViewGrid::kCount; ++node) {
      const std::span<const Rgb> row = glossy.matrices.of(i).subspan(size_t(node) * 10, 10);
      const double constant = std::sqrt(4 * kPiD) * double(row[0].x);
      EXPECT_GT(constant, 0.6);
      EXPECT_LT(constant, 1.02);
      const vec3 view = ViewGrid::direction(node);
      const vec3 mirror = frame.toWorld(vec3(-view.x, -view.y, view.z));
      // The first band, as a vector, points towards the light that the surface reflects.
      const vec3 from = glm::normalize(vec3(row[3].x, row[1].x, row[2].x));
      same += double(glm::dot(from, mirror));
      opposite += double(glm::dot(from, frame.toWorld(view)));
    }
  }
  const auto count = double(e.points.size() * ViewGrid::kCount);
  EXPECT_GT(same / count, 0.9);
  EXPECT_LT(opposite / count, 0.6);
}

// Lamps a thousand times as bright, under a probe as bright, are the same lighting: a compression
// keeps the same of it.
TEST(GlossyTransfer, TheUnitOfRadianceDoesNotDecideWhatIsKept) {
  const auto compressed = [](float scale) {
    Scene scene = sphereOf(lambert(Rgb(0.5f)));
    Material lamp = lambert(Rgb(0));
    lamp.emission = Rgb(scale * 3);
    addSphere(scene, addMaterial(scene, lamp), {0, 3, 0}, 0.5f, 6, false);
    const Estimated e(scene, {.samples = 16});
    const GlossyTransfer glossy = e.glossy();
    const ClusteredPca pca = clusteredPca(signalsOf(glossy), 2, 2);
    return std::pair(pca.error, glossyFile(e.meshes, e.points, glossy, pca).tables[0].elements);
  };
  const auto [error, mean] = compressed(1);
  const auto [brightError, bright] = compressed(1024);
  EXPECT_EQ(brightError, error);
  ASSERT_EQ(bright.size(), mean.size());
  double own = 0;
  for (size_t i = 0; i < mean.size(); ++i) {
    const bool isOwn = (i + 1) % 10 == 0;
    own += isOwn ? double(mean[i].x) : 0;
    EXPECT_EQ(bright[i], (isOwn ? 1024.0f : 1.0f) * mean[i]);
  }
  EXPECT_GT(own, 0);
}

TEST(GlossyTransfer, SameBitsForAnyNumberOfThreads) {
  const Scene scene = sphereOf(lambert(Rgb(0.5f)));
  const Estimated e(scene, {.samples = 4});
  const auto valuesOf = [&](size_t threads) {
    const ThreadLimit limit(threads);
    return e.glossy().matrices.values;
  };
  EXPECT_EQ(valuesOf(1), valuesOf(3));
}

}  // namespace
}  // namespace chromeball::glossy_transfer_test
