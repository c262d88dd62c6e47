// SPDX-License-Identifier: Apache-2.0
// Primitives of equal geometry become one mesh with several instances.
#include <gtest/gtest.h>

#include "gltf_writer.h"

namespace chromeball::gltf_instances_test {
namespace {

using nlohmann::json;

// Whether two primitives, equal except for the given members, become one mesh.
bool shareOneMesh(const json& material, const json& otherMaterial, const json& other = {}) {
  GltfWriter w;
  w.write("wood.png", kPng);
  w.root["images"] = {{{"uri", "wood.png"}}};
  w.root["textures"] = {{{"source", 0}}};
  const json attributes = {{"POSITION", w.vec3s({0, 0, 0, 2, 0, 0, 0, 2, 0})},
                           {"TEXCOORD_0", w.vec2s({0, 0, 1, 0, 0, 1})},
                           {"TEXCOORD_1", w.vec2s({0, 0, 2, 0, 0, 2})}};
  json second = {{"attributes", attributes}, {"material", w.add("materials", otherMaterial)}};
  if (!other.is_null()) second.merge_patch(other);
  w.add(
      "nodes",
      {{"mesh", w.mesh({{"attributes", attributes}, {"material", w.add("materials", material)}})}});
  w.add("nodes", {{"mesh", w.mesh(second)}, {"translation", {1, 0, 0}}});
  const Scene scene = w.load();
  EXPECT_EQ(scene.instances.size(), 2u);
  EXPECT_NE(scene.instances[0].material, scene.instances[1].material);
  return scene.meshes.size() == 1;
}

TEST(GltfInstances, PrimitivesOfOneGeometryShareAMesh) {
  const auto textured = [](const char* slot, int uvSet) -> json {
    const json texture = {{"index", 0}, {"texCoord", uvSet}};
    if (std::string(slot) == "normalTexture") return {{slot, texture}};
    return {{"pbrMetallicRoughness", {{slot, texture}}}};
  };
  const json plain = json::object(), rough = {{"pbrMetallicRoughness", {{"metallicFactor", 0.5}}}};
  EXPECT_TRUE(shareOneMesh(plain, rough));
  EXPECT_TRUE(shareOneMesh({{"alphaMode", "MASK"}}, {{"alphaMode", "BLEND"}}));
  EXPECT_TRUE(
      shareOneMesh(textured("baseColorTexture", 1), textured("metallicRoughnessTexture", 1)));
  // Different vertices, or different attributes kept:
  EXPECT_FALSE(shareOneMesh(plain, rough, {{"mode", 5}}));
  EXPECT_FALSE(shareOneMesh(plain, textured("baseColorTexture", 0)));
  EXPECT_FALSE(shareOneMesh(textured("baseColorTexture", 0), textured("baseColorTexture", 1)));
  EXPECT_FALSE(shareOneMesh(textured("baseColorTexture", 0), textured("normalTexture", 0)));
  EXPECT_FALSE(shareOneMesh(plain, {{"alphaMode", "BLEND"}}));
}

TEST(GltfInstances, EqualMorphWeightsShareAMesh) {
  GltfWriter w;
  const int up = w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int node = addTriangle(w, {{"targets", {{{"POSITION", up}}}}});
  for (double weight : {0.5, 0.5, 2.0})
    w.add("nodes", {{"mesh", w.root["nodes"][size_t(node)]["mesh"]}, {"weights", {weight}}});
  const Scene scene = w.load();
  EXPECT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.instances[1].mesh, scene.instances[2].mesh);
}

// Two nodes place a mesh, which is far from its own origin, at the world's: its coordinates are
// relative to its middle then, and rounding errors are those of its size (8 cm else).
TEST(GltfInstances, AMeshFarFromItsOriginIsMovedThere) {
  GltfWriter w;
  const float far = 1e4f;
  const int positions = w.vec3s({far, far, far, far + 2, far, far, far, far + 2, far});
  w.root["accessors"][size_t(positions)]["max"] = {1, 1, 1};  // does not matter
  const int mesh = w.mesh({{"attributes", {{"POSITION", positions}}}});
  w.add("nodes", {{"mesh", mesh}, {"translation", {-far, -far, -far}}});
  w.add("nodes", {{"mesh", mesh}, {"translation", {far, -far, -far}}, {"scale", {-1, 1, 1}}});
  const Scene scene = w.load();
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& read = scene.meshes[0];
  for (const vec3& p : read.positions) EXPECT_LT(glm::length(p), 2);
  const vec3 corners[3]{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT(glm::length(scene.instances[0].point(read.positions[i]) - corners[i]), 1e-6f);
    const vec3 mirrored = corners[i] * vec3(-1, 1, 1);
    EXPECT_LT(glm::length(scene.instances[1].point(read.positions[i]) - mirrored), 1e-6f);
  }
  EXPECT_LT(glm::length(scene.instances[0].toWorld->reach(read.positions[1])), 5);
}

}  // namespace
}  // namespace chromeball::gltf_instances_test
