// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"
#include "scene/bounds.h"

#include <gtest/gtest.h>

namespace chromeball::scene_test {
namespace {

// One triangle, one material with a texture, one node.
Scene makeScene(const std::string& name) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  scene.meshes.push_back(mesh);
  scene.instances.push_back({});
  Material material;
  material.name = name;
  material.normalTexture.texture = 0;
  scene.materials.push_back(material);
  scene.grids.push_back(std::make_unique<TexelGrid>());
  scene.grids[0]->texels8.resize(16);
  scene.textures.push_back({scene.grids[0].get()});
  scene.nodeNames.push_back(name);
  scene.cameras.emplace_back().name = name;
  return scene;
}

TEST(Scene, CountsInstancedTrianglesOncePerInstance) {
  Scene scene = makeScene("a");
  scene.instances.push_back({});
  EXPECT_EQ(scene.triangleCount(), 2u);
}

TEST(Scene, ByteCountGrowsWithGeometryAndTexels) {
  Scene scene = makeScene("a");
  const size_t before = scene.byteCount();
  scene.grids[0]->texels8.resize(1016);
  EXPECT_EQ(scene.byteCount(), before + 4000);
  scene.meshes.edit(0).uvs = {{}, {{0, 0}, {0, 0}, {0, 0}}};
  EXPECT_EQ(scene.byteCount(), before + 4000 + 24);
}

TEST(Scene, BoundsFollowInstances) {
  Scene scene = makeScene("a");
  EXPECT_TRUE(bounds(Scene()).empty());
  EXPECT_EQ(bounds(scene).max, vec3(1, 1, 0));
  scene.instances.push_back({0, 0, 0, Transform{glm::mat3(-2), {0, 0, 5}}});
  EXPECT_EQ(bounds(scene).min, vec3(-2, -2, 0));
  EXPECT_EQ(bounds(scene).max, vec3(1, 1, 5));
}

TEST(Scene, BoundsOfManyPoints) {
  std::vector<vec3> points(100'000, vec3(1));
  points[70'001] = vec3(-3, 2, 1);
  points.back() = vec3(1, 1, 9);
  EXPECT_EQ(bounds(points).min, vec3(-3, 1, 1));
  EXPECT_EQ(bounds(points).max, vec3(1, 2, 9));
}

TEST(Scene, AppendRenumbersEverything) {
  Scene scene = makeScene("a");
  append(scene, makeScene("b"));
  append(scene, Scene());
  ASSERT_EQ(scene.instances.size(), 2u);
  const Instance& second = scene.instances[1];
  EXPECT_EQ(second.mesh, 1);
  EXPECT_EQ(scene.nodeNames[size_t(second.node)], "b");
  const Material& material = scene.materials[size_t(second.material)];
  EXPECT_EQ(material.name, "b");
  EXPECT_EQ(material.normalTexture.texture, 1);
  EXPECT_EQ(material.baseColorTexture.texture, -1);
  EXPECT_EQ(scene.textures[1].grid, scene.grids[1].get());
  EXPECT_EQ(scene.cameras.size(), 2u);
}

}  // namespace
}  // namespace chromeball::scene_test
