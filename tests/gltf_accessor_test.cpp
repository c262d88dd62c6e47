// SPDX-License-Identifier: Apache-2.0
// Reading accessors, and rejecting those that exceed their buffers.
#include <gtest/gtest.h>

#include "gltf_writer.h"

namespace chromeball::gltf_accessor_test {
namespace {

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

// Reads the accessor as the vertex colours of a triangle.
std::vector<vec4> readAsColors(GltfWriter& w, int accessor) {
  addTriangle(w, {{"attributes", {{"COLOR_0", accessor}}}});
  return w.load().meshes.at(0).colors;
}

template <class T>
void expectColor(ComponentType component, std::vector<T> one, vec4 expected) {
  GltfWriter w;
  std::vector<T> three;
  for (int i = 0; i < 3; ++i) three.insert(three.end(), one.begin(), one.end());
  const std::vector<vec4> colors =
      readAsColors(w, w.accessor(w.view(three), component, one.size() == 4 ? "VEC4" : "VEC3", 3, 0,
                                 component != kFloat));
  ASSERT_EQ(colors.size(), 3u);
  for (const vec4& c : colors)
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(c[k], expected[k], 1e-6f) << component;
}

TEST(GltfAccessor, NormalisedColoursOfEveryType) {
  expectColor<float>(kFloat, {0.25f, 0.5f, 2, 0.75f}, {0.25f, 0.5f, 2, 0.75f});
  expectColor<float>(kFloat, {0.25f, 0.5f, 1}, {0.25f, 0.5f, 1, 1});
  expectColor<uint8_t>(kUByte, {0, 51, 255, 102}, {0, 0.2f, 1, 0.4f});
  expectColor<uint16_t>(kUShort, {0, 13107, 65535, 26214}, {0, 0.2f, 1, 0.4f});
}

TEST(GltfAccessor, NormalisedSignedHasTwoCodesForMinusOne) {
  GltfWriter w;
  w.root["extensionsUsed"] = w.root["extensionsRequired"] =
      nlohmann::json::array({"KHR_mesh_quantization"});
  const int positions =
      w.accessor(w.view(std::vector<int8_t>{-128, -127, 127, 0, 0, 0, 0, 99, 127, 0, 0, 0}, 4),
                 kByte, "VEC3", 3, 0, true);
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}})}});
  // Each vertex has three bytes and one of padding.
  EXPECT_EQ(w.load().meshes[0].positions, (std::vector<vec3>{{-1, -1, 1}, {0, 0, 0}, {1, 0, 0}}));
}

TEST(GltfAccessor, QuantisedPositionsAreIntegersUnlessNormalised) {
  GltfWriter w;
  const int positions =
      w.accessor(w.view(std::vector<int16_t>{-300, 0, 7, 0, 200, 0, 0, 0, 0, 32767, 1, 0}, 8),
                 kShort, "VEC3", 3);
  w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}})}});
  EXPECT_EQ(w.load().meshes[0].positions,
            (std::vector<vec3>{{-300, 0, 7}, {200, 0, 0}, {0, 32767, 1}}));
}

TEST(GltfAccessor, InterleavedAttributesShareAView) {
  GltfWriter w;
  // Position and colour alternate: 24 bytes per vertex.
  const int view = w.view(std::vector<float>{0, 0, 0, .1f, .2f, .3f, 1, 0, 0, .4f, .5f, .6f,  //
                                             0, 1, 0, .7f, .8f, .9f},
                          24);
  const int positions = w.accessor(view, kFloat, "VEC3", 3);
  const int colors = w.accessor(view, kFloat, "VEC3", 3, 12);
  w.add("nodes",
        {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}})}});
  const Mesh mesh = w.load().meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.colors, (std::vector<vec4>{{.1f, .2f, .3f, 1},
                                            {.4f, .5f, .6f, 1},  //
                                            {.7f, .8f, .9f, 1}}));
}

TEST(GltfAccessor, IndicesOfEveryType) {
  const auto triangles = [](auto indices, ComponentType component) {
    GltfWriter w;
    const int accessor = w.accessor(w.view(indices), component, "SCALAR", indices.size());
    w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", w.vec3s(kSquare)}}},
                                     {"indices", accessor}})}});
    return w.load().meshes[0].triangles;
  };
  const std::vector<Triangle> expected{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(triangles(std::vector<uint8_t>{0, 1, 2, 0, 2, 3}, kUByte), expected);
  EXPECT_EQ(triangles(std::vector<uint16_t>{0, 1, 2, 0, 2, 3}, kUShort), expected);
  EXPECT_EQ(triangles(std::vector<uint32_t>{0, 1, 2, 0, 2, 3}, kUInt), expected);
}

nlohmann::json sparse(int count, int indexView, ComponentType component, int valueView) {
  return {{"count", count},
          {"indices", {{"bufferView", indexView}, {"componentType", component}}},
          {"values", {{"bufferView", valueView}}}};
}

TEST(GltfAccessor, SparseReplacesElements) {
  for (const bool backed : {true, false}) {
    GltfWriter w;
    const int values = w.view(std::vector<float>{5, 6, 7, 1, 2, 3});
    const int indices = w.view(std::vector<uint8_t>{0, 2});
    const int base = backed ? w.view(std::vector<float>{9, 9, 9, 4, 0, 0, 9, 9, 9}) : -1;
    const int positions = w.accessor(base, kFloat, "VEC3", 3);
    w.root["accessors"][size_t(positions)]["sparse"] = sparse(2, indices, kUByte, values);
    w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_EQ(w.load().meshes[0].positions,
              (std::vector<vec3>{{5, 6, 7}, {backed ? 4.f : 0.f, 0, 0}, {1, 2, 3}}));
  }
}

TEST(GltfAccessor, SparseIndicesWithoutABufferView) {
  GltfWriter w;
  const int positions = w.vec3s({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices = w.accessor(-1, kUShort, "SCALAR", 3);
  w.root["accessors"][size_t(indices)]["sparse"] =
      sparse(2, w.view(std::vector<uint8_t>{1, 2}), kUByte, w.view(std::vector<uint16_t>{1, 2}));
  w.add("nodes",
        {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
  EXPECT_EQ(w.load().meshes[0].triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(GltfAccessor, RejectsElementsOutsideTheBuffer) {
  const auto errorMessage = [](const nlohmann::json& accessorPatch,
                               const nlohmann::json& viewPatch) {
    GltfWriter w;
    addTriangle(w);
    w.root["accessors"][0].merge_patch(accessorPatch);
    w.root["bufferViews"][0].merge_patch(viewPatch);
    return w.errorMessage();
  };
  const auto none = nlohmann::json::object();
  EXPECT_EQ(errorMessage(none, none), "");
  const char* position = "meshes[0].primitives[0].attributes.POSITION: ";
  for (const nlohmann::json& patch :
       std::vector<nlohmann::json>{{{"count", 4}},
                                   {{"byteOffset", 4}},
                                   {{"count", 9007199254740992u}},
                                   {{"byteOffset", 9007199254740992u}},
                                   {{"bufferView", 7}},
                                   {{"type", "VEC4"}},
                                   {{"type", "MAT4"}},
                                   {{"componentType", 5130}},
                                   {{"componentType", 5124}},
                                   {{"count", 0}}}) {
    EXPECT_TRUE(errorMessage(patch, none).starts_with(position))
        << patch << errorMessage(patch, none);
  }
  for (const nlohmann::json& patch :
       std::vector<nlohmann::json>{{{"byteLength", 37}},
                                   {{"byteOffset", 1}},
                                   {{"byteOffset", 9007199254740992u}},
                                   {{"buffer", 1}},
                                   {{"byteStride", 16}},
                                   {{"byteStride", 4}}}) {
    EXPECT_TRUE(errorMessage(none, patch).starts_with(position))
        << patch << errorMessage(none, patch);
  }
  for (const nlohmann::json& patch : std::vector<nlohmann::json>{
           {{"byteOffset", 18446744073709551615u}}, {{"byteOffset", -1}}, {{"buffer", -1}}})
    EXPECT_TRUE(errorMessage(none, patch).starts_with("bufferViews[0].b"))
        << patch << errorMessage(none, patch);
  EXPECT_NE(
      errorMessage({{"bufferView", nullptr}, {"count", 1000000000000}}, none).find("the limit is"),
      std::string::npos);
}

TEST(GltfAccessor, RejectsSparseDataOutsideTheBuffer) {
  const auto errorMessage = [](const nlohmann::json& patch) {
    GltfWriter w;
    addTriangle(w);
    w.root["accessors"][0]["sparse"] =
        sparse(1, w.view(std::vector<uint16_t>{2}), kUShort, w.view(std::vector<float>{1, 2, 3}));
    w.root["accessors"][0]["sparse"].merge_patch(patch);
    return w.errorMessage();
  };
  EXPECT_EQ(errorMessage(nlohmann::json::object()), "");
  EXPECT_NE(errorMessage({{"count", 2}}), "");
  EXPECT_NE(errorMessage({{"count", -1}}), "");
  EXPECT_NE(errorMessage({{"count", 4}}), "");
  EXPECT_NE(errorMessage({{"indices", {{"bufferView", 9}}}}), "");
  EXPECT_NE(errorMessage({{"indices", {{"componentType", kFloat}}}}), "");
  EXPECT_NE(errorMessage({{"indices", {{"byteOffset", -2}}}}), "");
  EXPECT_NE(errorMessage({{"values", {{"byteOffset", 4}}}}), "");
}

TEST(GltfAccessor, RejectsSparseIndicesOutOfRange) {
  GltfWriter w;
  addTriangle(w);
  w.root["accessors"][0]["sparse"] =
      sparse(1, w.view(std::vector<uint16_t>{3}), kUShort, w.view(std::vector<float>{1, 2, 3}));
  EXPECT_EQ(w.errorMessage(),
            "meshes[0].primitives[0].attributes.POSITION: accessors[0].sparse: index 3 out of "
            "range (3 elements)");
}

TEST(GltfAccessor, RejectsIndicesOutOfRange) {
  const auto errorMessage = [](std::vector<uint16_t> indices) {
    GltfWriter w;
    addTriangle(w, {{"indices", w.indices(indices)}});
    return w.errorMessage();
  };
  EXPECT_EQ(errorMessage({0, 1, 2}), "");
  EXPECT_EQ(errorMessage({0, 1, 3}),
            "meshes[0].primitives[0].indices: index 3 out of range (3 vertices)");
  EXPECT_EQ(errorMessage({0, 65535, 2}),
            "meshes[0].primitives[0].indices: index 65535 is the primitive-restart value, "
            "which glTF forbids");
}

TEST(GltfAccessor, RejectsPositionsThatAreNotFinite) {
  for (const float bad : {NAN, INFINITY}) {
    GltfWriter w;
    const int positions = w.vec3s({0, 0, 0, 1, 0, 0, 0, bad, 0});
    w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", positions}}}})}});
    EXPECT_EQ(w.errorMessage(), "meshes[0].primitives[0]: the position of vertex 2 is not finite");
  }
}

TEST(GltfAccessor, RejectsAttributesOfDifferentLength) {
  GltfWriter w;
  addTriangle(w, {{"attributes", {{"NORMAL", w.vec3s({0, 0, 1, 0, 0, 1})}}}});
  EXPECT_EQ(w.errorMessage(),
            "meshes[0].primitives[0].attributes.NORMAL: 2 elements for 3 vertices");
}

}  // namespace
}  // namespace chromeball::gltf_accessor_test
