// SPDX-License-Identifier: Apache-2.0
// The structure of glTF files: primitives, nodes, instances, cameras, poses.
#include <gtest/gtest.h>

#include "gltf_writer.h"

namespace chromeball::gltf_test {
namespace {

using nlohmann::json;

std::vector<Triangle> trianglesOf(int mode, const std::vector<uint16_t>& indices) {
  GltfWriter w;
  const int positions = w.vec3s({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0});
  json primitive = {{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
  if (!indices.empty()) primitive["indices"] = w.indices(indices);
  w.add("nodes", {{"mesh", w.mesh(primitive)}});
  return w.load().meshes.at(0).triangles;
}

TEST(Gltf, TrianglesStripsAndFans) {
  EXPECT_EQ(trianglesOf(4, {0, 1, 2, 2, 1, 3, 4, 4}),  // two surplus indices
            (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
  EXPECT_EQ(trianglesOf(5, {0, 1, 2, 3, 4}),
            (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(trianglesOf(6, {0, 1, 2, 3, 4}),
            (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(trianglesOf(5, {}), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
}

TEST(Gltf, PrimitivesWithoutTrianglesAreIgnoredWithOneWarning) {
  GltfWriter w;
  addTriangle(w, {{"mode", 0}});
  addTriangle(w, {{"mode", 3}});
  EXPECT_TRUE(w.load().meshes.empty());
  ASSERT_EQ(w.warnings.size(), 1u);
  EXPECT_TRUE(w.warnings[0].ends_with("model.gltf: ignored: points and lines"));

  GltfWriter bare;
  bare.add("nodes", {{"mesh", bare.mesh({{"attributes", json::object()}})}});
  EXPECT_TRUE(bare.load().meshes.empty());
  EXPECT_EQ(bare.warnings.size(), 1u);
}

TEST(Gltf, UnusedVerticesAreDropped) {
  GltfWriter w;
  const int positions = w.vec3s({9, 9, 9, 0, 0, 0, 1, 0, 0, 9, 9, 9, 0, 1, 0});
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}},
                                   {"indices", w.indices({1, 2, 4})}})}});
  const Mesh mesh = w.load().meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Gltf, MeshesWithOneInstanceAreBakedOthersAreShared) {
  GltfWriter w;
  addTriangle(w, {}, {{"translation", {10, 0, 0}}, {"name", "alone"}});
  const int shared = w.mesh({{"attributes", {{"POSITION", w.vec3s({0, 0, 0, 2, 0, 0, 0, 2, 0})}}}});
  w.add("nodes", {{"mesh", shared}, {"translation", {0, 1, 0}}});
  w.add("nodes", {{"mesh", shared}, {"scale", {-1, 1, 1}}});
  const Scene scene = w.load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.triangleCount(), 3u);
  EXPECT_EQ(scene.meshes[0].positions[0], vec3(10, 0, 0));
  EXPECT_FALSE(scene.instances[0].toWorld);
  EXPECT_EQ(scene.nodeNames[size_t(scene.instances[0].node)], "alone");
  EXPECT_EQ(scene.meshes[1].positions[1], vec3(2, 0, 0));
  EXPECT_EQ(scene.instances[1].point({2, 0, 0}), vec3(2, 1, 0));
  EXPECT_EQ(scene.instances[2].point({2, 0, 0}), vec3(-2, 0, 0));
  EXPECT_LT(glm::determinant(scene.instances[2].toWorld->linear), 0);
}

TEST(Gltf, HierarchyAndPlacementCompose) {
  GltfWriter w;
  const int child = addTriangle(w, {}, {{"translation", {1, 0, 0}}});
  const double half = std::sqrt(0.5);  // a quarter turn about +Y: +X goes to -Z
  w.add("nodes", {{"rotation", {0, half, 0, half}}, {"scale", {2, 2, 2}}, {"children", {child}}});
  Transform placement;
  placement.translation = {0, 5, 0};
  const vec3 p = w.load(placement).meshes[0].positions[0];
  EXPECT_NEAR(p.x, 0, 1e-6f);
  EXPECT_NEAR(p.y, 5, 1e-6f);
  EXPECT_NEAR(p.z, -2, 1e-6f);
}

// The geometric normal remains on the side of the shading normal.
TEST(Gltf, MirroredNodesKeepTheirFrontFaces) {
  GltfWriter w;
  addTriangle(w, {{"attributes", {{"NORMAL", w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1})}}}},
              {{"matrix", {-2, 0, 0, 0, 0, 3, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1}}});
  const Mesh mesh = w.load().meshes[0];
  const Triangle t = mesh.triangles[0];
  const vec3 geometric = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                    mesh.positions[t.z] - mesh.positions[t.x]);
  EXPECT_GT(glm::dot(geometric, mesh.normals[0]), 0);
  // The shear maps the plane to itself; its normal needs the inverse transpose.
  EXPECT_NEAR(glm::dot(mesh.normals[0], mesh.positions[t.y] - mesh.positions[t.x]), 0, 1e-6f);
  EXPECT_NEAR(glm::length(mesh.normals[0]), 1, 1e-6f);
}

TEST(Gltf, InvalidNormalsAreRepaired) {
  GltfWriter w;
  addTriangle(w, {{"attributes", {{"NORMAL", w.vec3s({0, 0, 0, 0, 3, 0, NAN, 0, 1})}}}});
  const std::vector<vec3> normals = w.load().meshes[0].normals;
  EXPECT_EQ(normals, (std::vector<vec3>{{0, 0, 1}, {0, 1, 0}, {0, 0, 1}}));
}

TEST(Gltf, NodesWithoutAreaAreIgnored) {
  GltfWriter w;
  addTriangle(w, {}, {{"scale", {1, 0, 0}}});
  addTriangle(w, {}, {{"scale", {0, 0, 0}}});
  addTriangle(w, {}, {{"scale", {1e-6, 1e-6, 1e-6}}});  // small, but invertible
  EXPECT_EQ(w.load().instances.size(), 1u);
  EXPECT_EQ(w.warnings.size(), 2u);
}

// A scale of 0 on one axis makes a solid a figure in a plane, whose normals are the plane's, on the
// side that its triangles face; however the node is turned.
TEST(Gltf, NodesMayFlattenTheirMeshes) {
  for (const bool isShared : {false, true})
    for (const double degrees : {0.0, 33.0, 180.0, 251.0}) {
      GltfWriter w;
      const double half = degrees * kPiD / 360;
      const json turn = {0.6 * std::sin(half), 0, 0.8 * std::sin(half), std::cos(half)};
      // Two sides of a roof, whose normals differ from the triangles'.
      const int mesh =
          w.mesh({{"attributes",
                   {{"POSITION", w.vec3s({0, 0, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, -1, 1, 0, 0, 0, 1})},
                    {"NORMAL",
                     w.vec3s({0, 1, 0, -.6f, .8f, 0, 0, .8f, .6f, 1, 0, 0, 0, 1, 0, 0, 1, 0})}}}});
      w.add("nodes", {{"mesh", mesh}, {"scale", {2, 0, 3}}, {"rotation", turn}});
      if (isShared)
        for (const double x : {5, 9}) w.add("nodes", {{"mesh", mesh}, {"translation", {x, 0, 0}}});
      const Scene scene = w.load();
      ASSERT_EQ(scene.instances.size(), isShared ? 3u : 1u);
      EXPECT_TRUE(w.warnings.empty());
      EXPECT_FALSE(scene.instances[0].toWorld);
      const Mesh& flat = scene.meshes[size_t(scene.instances[0].mesh)];
      const glm::dquat q(std::cos(half), 0.6 * std::sin(half), 0, 0.8 * std::sin(half));
      const glm::dvec3 up = q * glm::dvec3(0, 1, 0);
      for (size_t i = 0; i < flat.positions.size(); ++i) {
        EXPECT_NEAR(glm::dot(glm::dvec3(flat.positions[i]), up), 0, 1e-6);
        EXPECT_NEAR(glm::dot(glm::dvec3(flat.normals[i]), up), 1, 1e-6) << i << " " << degrees;
      }
      for (const Triangle& t : flat.triangles) {
        const vec3 a = flat.positions[t.x], b = flat.positions[t.y], c = flat.positions[t.z];
        EXPECT_NEAR(glm::dot(glm::dvec3(glm::cross(b - a, c - a)), up), 6, 1e-5);
      }
    }
}

TEST(Gltf, TheDefaultSceneSelectsTheNodes) {
  GltfWriter w;
  addTriangle(w);
  addTriangle(w, {}, {{"translation", {7, 0, 0}}});
  EXPECT_EQ(w.load().instances.size(), 2u);  // no scenes: all root nodes
  w.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
  EXPECT_EQ(w.load().instances.at(0).node, 1);  // no default: the first scene
  w.root["scene"] = 1;
  EXPECT_EQ(w.load().instances.at(0).node, 0);
  w.root["scene"] = 2;
  EXPECT_EQ(w.errorMessage(), "scene: scenes[2] does not exist (2 in the file)");
}

// The first index behind the last view, too.
TEST(Gltf, AccessorsOfMissingViewsAreRejected) {
  for (const int beyond : {0, 1}) {
    GltfWriter w;
    addTriangle(w);
    const int views = int(w.root["bufferViews"].size());
    w.root["accessors"][0]["bufferView"] = views + beyond;
    EXPECT_NE(
        w.errorMessage().find("bufferViews[" + std::to_string(views + beyond) + "] does not exist"),
        std::string::npos)
        << w.errorMessage();
  }
}

TEST(Gltf, CamerasBeyondTheRangeAreRejected) {
  GltfWriter w;
  addTriangle(w);
  w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  w.add("nodes", {{"camera", 0}, {"translation", {0, 1e39, 0}}});
  EXPECT_NE(w.errorMessage().find("nodes[1]: its camera is more than 1e9 m"), std::string::npos);
}

TEST(Gltf, MeshesWithoutNodesAreAtTheOrigin) {
  GltfWriter w;
  addTriangle(w);
  w.root.erase("nodes");
  EXPECT_EQ(w.load().instances.size(), 1u);
}

TEST(Gltf, NodesMustFormTrees) {
  GltfWriter w;
  w.root["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, json::object()};
  EXPECT_EQ(w.errorMessage(),
            "nodes[1].children: nodes[2] is also a child of nodes[0]; nodes must form trees");
  w.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  EXPECT_EQ(w.errorMessage(), "nodes[0]: is its own ancestor; nodes must form trees");
  w.root["nodes"] = {{{"children", {5}}}};
  EXPECT_EQ(w.errorMessage(), "nodes[0].children: nodes[5] does not exist (1 in the file)");
}

TEST(Gltf, VeryDeepHierarchiesLoad) {
  GltfWriter w;
  constexpr int kDepth = 20000;
  for (int i = 0; i < kDepth; ++i)
    w.add("nodes", {{"children", {i + 1}}, {"translation", {0, 0, 0.5}}});
  addTriangle(w);
  EXPECT_EQ(w.load().meshes[0].positions[0], vec3(0, 0, kDepth / 2));
}

TEST(Gltf, CamerasHaveTheFramesOfTheirNodes) {
  GltfWriter w;
  w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  w.add("cameras", {{"type", "orthographic"},
                    {"name", "plan"},
                    {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
  // Rotated by 90 degrees about +Y; cameras ignore the non-uniform scale and the mirroring.
  const double half = std::sqrt(0.5);
  w.add("nodes", {{"camera", 0},
                  {"name", "eye"},
                  {"translation", {1, 2, 3}},
                  {"rotation", {0, half, 0, half}},
                  {"scale", {-1, 2, 5}}});
  w.add("nodes", {{"camera", 1}});
  const Scene scene = w.load();
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& eye = scene.cameras[0];
  EXPECT_EQ(eye.name, "eye");
  EXPECT_EQ(eye.position, vec3(1, 2, 3));
  EXPECT_NEAR(glm::distance(eye.back, vec3(1, 0, 0)), 0, 1e-6f);
  EXPECT_NEAR(glm::distance(eye.up, vec3(0, 1, 0)), 0, 1e-6f);
  EXPECT_NEAR(glm::distance(eye.right, vec3(0, 0, -1)), 0, 1e-6f);
  EXPECT_EQ(eye.fov, 0.5f);
  EXPECT_TRUE(scene.cameras[1].orthographic);
  EXPECT_EQ(scene.cameras[1].name, "plan");
  EXPECT_EQ(scene.cameras[1].halfHeight, 2);
  EXPECT_NEAR(w.load({glm::mat3(0.5f), {}}).cameras[1].halfHeight, 1, 1e-6) << "of its unit";
  EXPECT_EQ(scene.cameras[1].aspect, 2);
}

TEST(Gltf, MorphWeightsOfTheNodeOverrideTheMesh) {
  GltfWriter w;
  const int up = w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int node = addTriangle(w, {{"targets", {{{"POSITION", up}}}}});
  w.root["meshes"][0]["weights"] = {0.5};
  EXPECT_EQ(w.load().meshes[0].positions[1], vec3(1, 0, 0.5f));
  w.root["nodes"][size_t(node)]["weights"] = {2};
  EXPECT_EQ(w.load().meshes[0].positions[1], vec3(1, 0, 2));
}

TEST(Gltf, SkinsBlendTheirJoints) {
  GltfWriter w;
  const int joints = w.accessor(w.view(std::vector<uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}),
                                kUByte, "VEC4", 3);
  const int weights = w.accessor(w.view(std::vector<float>{1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0}),
                                 kFloat, "VEC4", 3);
  // Skinned meshes ignore the transform of their own node, which is far away.
  const json patch = {{"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}};
  addTriangle(w, patch, {{"skin", 0}, {"translation", {100, 0, 0}}});
  w.add("nodes", {{"translation", {0, 0, 1}}});
  w.add("nodes", {{"translation", {0, 0, 3}}});
  w.add("skins", {{"joints", {1, 2}}});
  EXPECT_EQ(w.load().meshes[0].positions, (std::vector<vec3>{{0, 0, 1}, {1, 0, 2}, {0, 1, 3}}));
  w.root["skins"][0]["joints"] = {1};
  EXPECT_EQ(w.errorMessage(),
            "meshes[0].primitives[0].attributes.JOINTS_0: joint 1 out of range (1 joints)");
}

}  // namespace
}  // namespace chromeball::gltf_test
