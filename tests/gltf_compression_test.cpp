// SPDX-License-Identifier: Apache-2.0
// Compressed and instanced geometry: decoding gives the original, and damaged data is rejected.
#include <gtest/gtest.h>

#include <algorithm>

#include "gltf_writer.h"
#include "scene/bounds.h"
#include "scene/gltf/load_gltf.h"
#include "shared_data.h"

namespace chromeball::gltf_compression_test {
namespace {

using nlohmann::json;
using Data = std::vector<uint8_t>;

// The unit square in the plane z = 0, encoded by meshoptimizer and Draco: positions
// (0,0) (1,0) (0,1) (1,1), indices 0 1 2 2 1 3, and for Draco the same as texture coordinates.
const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
const Data kPositions = {0xa0, 0, 0,    1,    0x3f, 0, 0, 0, 0xff, 0xff, 0xff, 1, 0x3f, 0,
                         0,    0, 0x7e, 0x7d, 0x7e, 0, 0, 1, 0x0c, 0,    0,    0, 0xff, 1,
                         0x0c, 0, 0,    0,    0x7e, 0, 0, 0, 0,    0,    0,    0, 0,    0,
                         0,    0, 0,    0,    0,    0, 0, 0, 0,    0,    0,    0, 0,    0,
                         0,    0, 0,    0,    0,    0, 0, 0, 0,    0,    0,    0, 0};
const Data kTriangles = {0xe1, 0xf0, 0x10, 0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xa9,
                         0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0x00, 0x00};
const Data kIndices = {0xd1, 0, 4, 4, 0, 2, 8, 0, 0, 0, 0};
const Data kSequential = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x00, 0x00, 0x00, 0x02, 0x04, 0x01, 0x00, 0x01,
    0x02, 0x02, 0x01, 0x03, 0x01, 0x02, 0x00, 0x09, 0x03, 0x00, 0x00, 0x03, 0x09, 0x02, 0x00, 0x01,
    0x02, 0x02, 0x00, 0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x30, 0x01, 0x10, 0x03, 0x00, 0x28, 0x82,
    0x88, 0x11, 0x00, 0x00, 0x00, 0x00, 0xff, 0x03, 0x00, 0x00, 0x00, 0x01, 0x01, 0x00, 0x03, 0x03,
    0x01, 0x30, 0x01, 0x10, 0x03, 0x00, 0x28, 0x82, 0x64, 0x01, 0x00, 0x00, 0x00, 0x00, 0xff, 0x03,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x80, 0x3f, 0x0a, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0a};
constexpr size_t kSequentialFaces = 11;  // offset of the number of triangles
const Data kEdgebreaker = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x01, 0x00, 0x00, 0x00, 0x04, 0x02, 0x01, 0x02,
    0x00, 0x00, 0x01, 0x1f, 0xff, 0x01, 0x11, 0xff, 0x01, 0x11, 0x02, 0xff, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x01, 0x00, 0x09, 0x03, 0x00, 0x00, 0x02, 0x01, 0x03, 0x09, 0x02, 0x00, 0x01, 0x02, 0x01,
    0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x30, 0x01, 0x10, 0x03, 0x00, 0x24, 0x82, 0x4a, 0x04, 0x00,
    0x00, 0x00, 0x00, 0xff, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0a, 0x01, 0x01, 0x01, 0x00, 0x03, 0x03, 0x01, 0x30,
    0x01, 0x10, 0x03, 0x00, 0x24, 0x82, 0xa6, 0x00, 0x00, 0x00, 0x00, 0x00, 0xff, 0x03, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x0a};
constexpr size_t kEdgebreakerFaces = 13;

// A buffer view of `count` elements of `stride` bytes in compressed form only.
int meshoptView(GltfWriter& w, const Data& data, const char* mode, size_t count, size_t stride,
                const json& more = json::object(), const char* name = "EXT_meshopt_compression") {
  const int view = w.view(data);
  json& v = w.root["bufferViews"][size_t(view)];
  json extension = {{"buffer", 0},
                    {"byteOffset", v["byteOffset"]},
                    {"byteLength", data.size()},
                    {"mode", mode},
                    {"count", count},
                    {"byteStride", stride}};
  extension.merge_patch(more);
  v = {{"buffer", 1}, {"byteLength", count * stride}};
  v["extensions"][name] = extension;
  return view;
}

GltfWriter& square(GltfWriter& w, int positions, int indices) {
  w.root["extensionsRequired"] = {"EXT_meshopt_compression"};
  w.add("nodes",
        {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
  return w;
}

TEST(GltfCompression, MeshoptDecodesToTheOriginal) {
  for (const bool strip : {false, true}) {
    GltfWriter w;
    const int positions =
        w.accessor(meshoptView(w, kPositions, "ATTRIBUTES", 4, 12), kFloat, "VEC3", 4);
    const int view = strip ? meshoptView(w, kIndices, "INDICES", 6, 4)
                           : meshoptView(w, kTriangles, "TRIANGLES", 6, 4);
    const Scene scene = square(w, positions, w.accessor(view, kUInt, "SCALAR", 6)).load();
    const std::vector<vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    EXPECT_EQ(scene.meshes.at(0).positions, corners);
    ASSERT_EQ(scene.meshes[0].triangles.size(), 2u);
    EXPECT_EQ(bounds(scene).max, vec3(1, 1, 0));
    // The triangle coder may rotate the vertices of a triangle, but keeps their orientation.
    for (const Triangle& t : scene.meshes[0].triangles) {
      const auto& p = scene.meshes[0].positions;
      EXPECT_EQ(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]), vec3(0, 0, 1));
    }
  }
}

// KHR_meshopt_compression is the same but for a second version of the vertex stream and a filter,
// which are refused by name.
TEST(GltfCompression, MeshoptOfKhronosIsTheSame) {
  const char* name = "KHR_meshopt_compression";
  const auto write = [&](GltfWriter& w, const json& change, Data data) {
    const int view = meshoptView(w, data, "ATTRIBUTES", 4, 12, change, name);
    square(w, w.accessor(view, kFloat, "VEC3", 4), w.indices({0, 1, 2}));
    w.root["extensionsRequired"] = {name};
  };
  GltfWriter w;
  write(w, json::object(), kPositions);
  EXPECT_EQ(w.load().meshes.at(0).positions.at(1), vec3(1, 0, 0));
  GltfWriter coloured;
  write(coloured, {{"filter", "COLOR"}}, kPositions);
  EXPECT_NE(coloured.errorMessage().find("COLOR is not supported"), std::string::npos);
  GltfWriter newer;
  Data second = kPositions;
  second[0] = 0xa1;
  write(newer, json::object(), second);
  EXPECT_NE(newer.errorMessage().find("version 1 of the vertex stream"), std::string::npos);
}

TEST(GltfCompression, MeshoptFilters) {
  // Mantissa x 2^exponent: (0,0,0) (1 x 2^1,0,0) (0,-6 x 2^-1,0).
  Data exponential = {0xa0, 1, 0x24, 0, 0, 0, 0, 0, 1, 0x24, 0, 0, 0, 1, 0x0c, 0, 0, 0,
                      0x0b, 1, 4,    0, 0, 0, 1, 4, 0, 0,    0, 1, 4, 0, 0,    0, 0, 0};
  exponential.resize(70);
  // The points (0,0) (1,0) (0,0) of the octahedron.
  Data octahedral = {0xa0, 1, 0x3c, 0, 0, 0, 0xfe, 0xfd};
  octahedral.resize(43);
  octahedral[41] = 0x7f;
  // (0, 0, 1/2) and the largest component, w.
  Data quaternion = {0xa0, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00};
  quaternion.resize(41);
  quaternion[37] = 0x81, quaternion[38] = 0x5a, quaternion[39] = 0xff, quaternion[40] = 0x7f;

  GltfWriter w;
  w.root["extensionsRequired"] = {"EXT_meshopt_compression", "EXT_mesh_gpu_instancing"};
  const int positions =
      w.accessor(meshoptView(w, exponential, "ATTRIBUTES", 3, 12, {{"filter", "EXPONENTIAL"}}),
                 kFloat, "VEC3", 3);
  const int normalView = meshoptView(w, octahedral, "ATTRIBUTES", 3, 4, {{"filter", "OCTAHEDRAL"}});
  w.root["bufferViews"][size_t(normalView)]["byteStride"] = 4;
  const int normals = w.accessor(normalView, kByte, "VEC3", 3, 0, true);
  const int rotation =
      w.accessor(meshoptView(w, quaternion, "ATTRIBUTES", 1, 8, {{"filter", "QUATERNION"}}), kShort,
                 "VEC4", 1, 0, true);
  json node = {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}})}};
  w.add("nodes", node);
  EXPECT_EQ(w.load().meshes.at(0).positions, (std::vector<vec3>{{0, 0, 0}, {2, 0, 0}, {0, -3, 0}}));
  EXPECT_EQ(w.load().meshes[0].normals, (std::vector<vec3>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}}));

  w.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotation;
  const vec3 turned = w.load().meshes.at(0).positions.at(1);  // by 60 degrees about Z
  EXPECT_NEAR(glm::distance(turned, vec3(1, std::sqrt(3.0f), 0)), 0, 2e-4);
}

TEST(GltfCompression, InvalidMeshoptDataIsRejected) {
  const auto errorMessage = [](const json& change, const Data& data = kPositions) {
    GltfWriter w;
    const int view = meshoptView(w, data, "ATTRIBUTES", 4, 12, change);
    return square(w, w.accessor(view, kFloat, "VEC3", 4), w.indices({0, 1, 2})).errorMessage();
  };
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(errorMessage(json::object()), "");
  EXPECT_TRUE(
      holds(errorMessage({{"mode", "VERTICES"}}), "is not ATTRIBUTES, TRIANGLES or INDICES"));
  EXPECT_TRUE(holds(errorMessage({{"byteStride", 10}}), "10 is invalid for ATTRIBUTES"));
  EXPECT_TRUE(holds(errorMessage({{"filter", "OCTAHEDRAL"}}), "is invalid for"));
  EXPECT_TRUE(holds(errorMessage({{"filter", "LOUD"}}), "is invalid for"));
  EXPECT_TRUE(holds(errorMessage({{"buffer", 9}}), "buffers[9] does not exist"));
  EXPECT_TRUE(holds(errorMessage({{"buffer", 1}}), "buffers[1] does not exist"));
  EXPECT_TRUE(holds(errorMessage({{"byteLength", 4000}}), "which has"));
  EXPECT_TRUE(holds(errorMessage({{"count", -1}}), "must be a whole number"));
  EXPECT_TRUE(holds(errorMessage({{"count", 2000000000}}), "out of proportion to the length"));
  EXPECT_TRUE(holds(errorMessage({{"count", 5000000}}), "damaged data"));
  EXPECT_TRUE(holds(errorMessage({{"count", 3}}), "do not fit"));
  EXPECT_TRUE(holds(errorMessage(json::object(), Data(60, 0)), "damaged data"));
}

GltfWriter& dracoSquare(GltfWriter& w, const Data& data, size_t indexCount = 6) {
  w.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  json primitive = {{"attributes",
                     {{"POSITION", w.accessor(-1, kFloat, "VEC3", 4)},
                      {"TEXCOORD_0", w.accessor(-1, kFloat, "VEC2", 4)}}},
                    {"indices", w.accessor(-1, kUShort, "SCALAR", indexCount)}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", w.view(data)}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
  w.write("a.png", kPng);
  w.add("images", {{"uri", "a.png"}});
  w.add("textures", {{"source", 0}});
  primitive["material"] =
      w.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  w.add("nodes", {{"mesh", w.mesh(primitive)}});
  return w;
}

TEST(GltfCompression, DracoDecodesToTheOriginal) {
  for (const Data& data : {kSequential, kEdgebreaker}) {
    GltfWriter w;
    const Mesh mesh = dracoSquare(w, data).load().meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    ASSERT_EQ(mesh.positions.size(), 4u);
    for (size_t i = 0; i < 4; ++i)  // positions and texture coordinates still match
      EXPECT_NEAR(glm::distance(vec2(mesh.positions[i]), mesh.uvs.at(0)[i]), 0, 1e-6);
    double area = 0;
    for (const Triangle& t : mesh.triangles)
      area += glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                         mesh.positions[t.z] - mesh.positions[t.x])
                  .z /
              2;
    EXPECT_NEAR(area, 1, 1e-5);
  }
}

// Each primitive has the mesh of its own extension, also in accessors that others share.
TEST(GltfCompression, DracoPrimitivesMayShareAccessors) {
  Data wide = kSequential;  // a square of two metres
  const Data one = {0x80, 0x3f, 0x0a}, two = {0x00, 0x40, 0x0a};
  const auto at = std::ranges::search(wide, one).begin();
  std::copy(two.begin(), two.end(), at);
  for (const bool sharesIndices : {false, true})
    for (const bool sharesMesh : {false, true}) {
      GltfWriter w;
      dracoSquare(w, kSequential);
      json second = w.root["meshes"][0]["primitives"][0];
      if (!sharesIndices) second["indices"] = w.accessor(-1, kUShort, "SCALAR", 6);
      if (!sharesMesh)
        second["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = w.view(wide);
      w.root["meshes"][0]["primitives"].push_back(second);
      const Scene scene = w.load();
      ASSERT_EQ(scene.instances.size(), 2u);
      for (size_t m = 0; m < 2; ++m) {
        const Mesh& mesh = scene.meshes[size_t(scene.instances[m].mesh)];
        ASSERT_EQ(mesh.triangles.size(), 2u);
        float largest = 0;
        for (const vec3& p : mesh.positions) largest = std::max(largest, p.x);
        EXPECT_NEAR(largest, m == 0 || sharesMesh ? 1 : 2, 1e-5);
      }
    }
}

TEST(GltfCompression, DracoWithTooManyTrianglesIsRejectedBeforeDecoding) {
  for (const auto& [data, at] :
       {std::pair{kSequential, kSequentialFaces}, {kEdgebreaker, kEdgebreakerFaces}}) {
    Data hostile = data;
    const Data billion = {0x80, 0x94, 0xeb, 0xdc, 0x03};
    hostile.erase(hostile.begin() + long(at));
    hostile.insert(hostile.begin() + long(at), billion.begin(), billion.end());
    for (const size_t indexCount : {size_t(6), size_t(3000000000)}) {
      GltfWriter w;
      EXPECT_NE(
          dracoSquare(w, hostile, indexCount).errorMessage().find("claims 1000000000 triangles"),
          std::string::npos);
    }
  }
  GltfWriter old;
  Data data = kSequential;
  data[6] = 1;
  EXPECT_NE(dracoSquare(old, data).errorMessage().find("bitstream 2.2"), std::string::npos);
  GltfWriter noise;
  EXPECT_NE(dracoSquare(noise, Data(50, 7)).errorMessage().find("is not Draco"), std::string::npos);
}

// Data with any single byte changed, and data truncated anywhere.
TEST(GltfCompression, DamagedDataNeverCrashes) {
  int rejected = 0;
  for (const Data& good : {kSequential, kEdgebreaker})
    for (size_t i = 0; i < good.size(); ++i) {
      Data bad = good;
      bad[i] = uint8_t(bad[i] ^ (i % 3 ? 0xff : 1 << i % 8));
      if (i % 5 == 0) bad.resize(i);
      GltfWriter w;
      rejected += !dracoSquare(w, bad).errorMessage().empty();
    }
  EXPECT_GT(rejected, 50);
}

TEST(GltfCompression, UncompressedCopiesAreUsedWithoutDecoding) {
  GltfWriter w;
  addTriangle(w, {{"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 99}}}}}});
  EXPECT_EQ(w.load().triangleCount(), 1u);
}

TEST(GltfInstancing, AddsAnInstanceForEachTransform) {
  GltfWriter w;
  w.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  addTriangle(w, {}, {{"translation", {0, 0, 7}}});
  json& attributes = w.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes["TRANSLATION"] = w.vec3s({0, 0, 0, 5, 0, 0});
  attributes["SCALE"] = w.vec3s({1, 1, 1, 2, 2, 2});
  const Scene scene = w.load();
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].point({1, 0, 0}), vec3(1, 0, 7));
  EXPECT_EQ(scene.instances[1].point({1, 0, 0}), vec3(7, 0, 7));

  attributes["SCALE"] = w.vec3s({1, 1, 1});
  EXPECT_NE(w.errorMessage().find("1 elements for 2 instances"), std::string::npos);
}

TEST(GltfSamples, CompressedModelsEqualUncompressedOnes) {
  const auto load = [](const char* name) -> std::optional<Scene> {
    const auto path = sharedData(std::string("gltf/") + name);
    if (!path) return std::nullopt;
    return loadGltf(path->string(), {}, nullptr);
  };
  const std::pair<const char*, const char*> pairs[] = {
      {"Box/glTF/Box.gltf", "Box/glTF-Draco/Box.gltf"},
      {"Duck/glTF/Duck.gltf", "Duck/glTF-Draco/Duck.gltf"}};
  for (const auto& [plainName, compressedName] : pairs) {
    const auto plain = load(plainName), compressed = load(compressedName);
    if (!plain || !compressed) GTEST_SKIP() << "no sample models";
    EXPECT_EQ(plain->triangleCount(), compressed->triangleCount());
    const float tolerance = 2e-3f * glm::distance(bounds(*plain).min, bounds(*plain).max);
    EXPECT_NEAR(glm::distance(bounds(*plain).min, bounds(*compressed).min), 0, tolerance);
    EXPECT_NEAR(glm::distance(bounds(*plain).max, bounds(*compressed).max), 0, tolerance);
  }
}

}  // namespace
}  // namespace chromeball::gltf_compression_test
