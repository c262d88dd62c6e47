// SPDX-License-Identifier: Apache-2.0
// Opening glTF files: containers, versions, extensions, URIs.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "base/error.h"
#include "base/json.h"
#include "gltf_writer.h"
#include "json_file.h"
#include "scene/gltf/load_gltf.h"
#include "temporary_folder.h"
#include "trace/accel.h"

namespace chromeball::gltf_file_test {
namespace {

using nlohmann::json;

std::vector<uint8_t> glb(uint32_t version, const std::string& text,
                         const std::vector<float>& binary, int lengthError = 0,
                         bool isPadded = true) {
  std::vector<uint8_t> bytes;
  const auto word = [&](uint32_t w) {
    for (int i = 0; i < 4; ++i) bytes.push_back(uint8_t(w >> (8 * i)));
  };
  const std::string padded = text + std::string(isPadded ? (4 - text.size() % 4) % 4 : 0, ' ');
  const uint32_t binaryBytes = uint32_t(binary.size() * 4);
  bytes.insert(bytes.end(), {'g', 'l', 'T', 'F'});
  word(version);
  word(uint32_t(12 + 8 + padded.size() + 8 + binaryBytes) + uint32_t(lengthError));
  word(uint32_t(padded.size()));
  bytes.insert(bytes.end(), {'J', 'S', 'O', 'N'});
  bytes.insert(bytes.end(), padded.begin(), padded.end());
  word(binaryBytes);
  bytes.insert(bytes.end(), {'B', 'I', 'N', 0});
  const auto* from = reinterpret_cast<const uint8_t*>(binary.data());
  bytes.insert(bytes.end(), from, from + binaryBytes);
  return bytes;
}

std::string errorMessageOf(const std::filesystem::path& path,
                           ExternalFiles external = ExternalFiles::Refuse) {
  try {
    loadGltf(path.string(), {}, nullptr, {.external = external});
  } catch (const InputError& e) {
    return std::string(e.what()).substr(path.string().size() + 2);
  }
  return "";
}

// Chunks must end at multiples of 4 bytes, but not all writers ensure that.
TEST(GltfFile, GlbWithoutPadding) {
  GltfWriter w;
  addTriangle(w);
  w.save();
  w.root["buffers"] = {{{"byteLength", 36}}};
  for (int extra = 0; extra < 4; ++extra) {
    w.root["asset"]["generator"] = std::string(size_t(extra), 'x');
    w.write("model.glb",
            glb(2, jsonText(w.root), {0, 0, 0, 1, 0, 0, 0, 1, 0}, 0, /*isPadded=*/false));
    const Scene scene = loadGltf((w.folder() / "model.glb").string(), {}, nullptr);
    EXPECT_EQ(scene.meshes.at(0).positions[1], vec3(1, 0, 0)) << extra;
  }
}

TEST(GltfFile, ModelsAreKnownByTheirContents) {
  const TemporaryFolder folder;
  const auto begins = [&](const std::string& text) {
    std::ofstream(folder / "a.vrm") << text;
    return beginsAsGltf(folder / "a.vrm");
  };
  EXPECT_TRUE(begins("glTF\2\0\0\0"));
  EXPECT_TRUE(begins("\n {\"asset\": {}}"));
  EXPECT_TRUE(begins("\xef\xbb\xbf{}"));
  EXPECT_FALSE(begins("o cube\nv 0 0 0\n"));
  EXPECT_FALSE(begins(""));
  EXPECT_FALSE(beginsAsGltf(folder / "none.vrm"));
  EXPECT_FALSE(beginsAsGltf(folder / ""));
}

// tinygltf drops empty objects and arrays, and aborts where one is expected.
TEST(GltfFile, EmptyMembersOfExtensions) {
  const json object = json::object(), array = json::array();
  GltfWriter w;
  w.root["materials"] = {{{"extensions",
                           {{"KHR_materials_transmission", {{"transmissionTexture", object}}},
                            {"KHR_materials_clearcoat", {{"clearcoatNormalTexture", object}}},
                            {"KHR_materials_volume", object},
                            {"KHR_materials_sheen", object},
                            {"KHR_materials_pbrSpecularGlossiness", object}}}}};
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", object}}};
  w.root["extensions"]["KHR_materials_variants"] = {{"variants", array}};
  addTriangle(
      w, {{"material", 0}, {"extensions", {{"KHR_materials_variants", {{"mappings", array}}}}}},
      {{"extensions",
        {{"KHR_lights_punctual", {{"light", 0}}},
         {"KHR_node_visibility", object},
         {"EXT_mesh_gpu_instancing", {{"attributes", object}}}}}});
  addTriangle(
      w, {},
      {{"extensions", {{"KHR_lights_punctual", object}, {"EXT_mesh_gpu_instancing", object}}}});
  EXPECT_EQ(w.load().instances.size(), 2u);
}

// Whole numbers beyond int, with and without a fraction.
TEST(GltfFile, LargeNumbersInExtensions) {
  for (const char* number : {"2147483647", "2147483648", "10000000000", "1e10", "10000000000.5"}) {
    GltfWriter w;
    const json value = parseJson(number);
    w.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", value}}};
    w.root["materials"] = {
        {{"emissiveFactor", {1, 1, 1}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", value}}}}}}};
    addTriangle(w, {{"material", 0}}, {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = w.load();
    EXPECT_FLOAT_EQ(scene.materials.at(0).emission.x, float(value.get<double>())) << number;
    EXPECT_FLOAT_EQ(scene.lights.at(0).intensity.x, float(value.get<double>() / 683)) << number;
  }
}

// Numbers beyond float become its largest, with a warning.
TEST(GltfFile, NumbersBeyondFloat) {
  GltfWriter w;
  w.root["materials"] = {
      {{"extensions", {{"KHR_materials_specular", {{"specularColorFactor", {1e39, 1, 1e300}}}}}}}};
  addTriangle(w, {{"material", 0}});
  const Scene scene = w.load();
  EXPECT_TRUE(isFinite(scene.materials.at(0).specularColor));
  EXPECT_FALSE(w.warnings.empty());
}

// Two nodes of one mesh, which is traced as instances unless a scale would take rays beyond the
// numbers of the acceleration structure.
TEST(GltfFile, InstancesOfAnyScale) {
  for (const double scale : {1e-30, 1e-19, 1e-15, 1e-9, 1e-3, 1.0, 1e3, 1e9}) {
    const float size = float(1 / scale);
    GltfWriter w;
    w.mesh({{"attributes", {{"POSITION", w.vec3s({0, 0, 0, size, 0, 0, 0, size, 0})}}}});
    w.root["nodes"] = {{{"mesh", 0}, {"scale", {scale, scale, 1}}},
                       {{"mesh", 0}, {"scale", {scale, scale, scale}}, {"translation", {5, 0, 0}}}};
    w.root["scenes"] = {{{"nodes", {0, 1}}}};
    const Scene scene = w.load();
    ASSERT_EQ(scene.instances.size(), 2u) << scale;
    const Accel accel(scene);
    for (const float x : {0.0f, 5.0f})
      for (const float height : {1.0f, 1e3f, 1e6f}) {
        Hit hit;
        ASSERT_TRUE(accel.intersect({{x + 0.25f, 0.25f, height}, {0, 0, -1}}, 0, hit))
            << scale << " " << x;
        EXPECT_NEAR(hit.distance, height, 1e-5f * height) << scale;
        EXPECT_FALSE(accel.intersect({{x + 0.75f, 0.75f, height}, {0, 0, -1}}, 0, hit)) << scale;
      }
  }
}

// KHR_node_visibility hides meshes and lamps of a node and of its descendants, but no cameras.
TEST(GltfFile, HiddenNodes) {
  GltfWriter w;
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  w.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  const json lamp = {{"KHR_lights_punctual", {{"light", 0}}}};
  const auto visible = [](bool is) { return json{{"visible", is}}; };
  addTriangle(w, {}, {{"name", "shown"}, {"extensions", lamp}});
  const int child =
      addTriangle(w, {}, {{"camera", 0}, {"extensions", {{"KHR_node_visibility", visible(true)}}}});
  json hidden = lamp;
  hidden["KHR_node_visibility"] = visible(false);
  const int parent = addTriangle(w, {}, {{"children", {child}}, {"extensions", hidden}});
  w.root["scenes"] = {{{"nodes", {0, parent}}}};
  w.root["extensionsRequired"] = {"KHR_node_visibility"};
  const Scene scene = w.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.nodeNames[size_t(scene.instances[0].node)], "shown");
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST(GltfFile, GlbChunks) {
  GltfWriter w;
  addTriangle(w);
  w.save();
  w.root["buffers"] = {{{"byteLength", 36}}};
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const auto path = w.folder() / "model.glb";
  w.write("model.glb", glb(2, jsonText(w.root), positions));
  EXPECT_EQ(loadGltf(path.string(), {}, nullptr).meshes.at(0).positions[1], vec3(1, 0, 0));

  w.write("model.glb", glb(2, jsonText(w.root), {0, 0, 0}));
  EXPECT_EQ(errorMessageOf(path), "buffers[0]: byteLength is 36, but there are only 12 bytes");
  w.write("model.glb", glb(2, jsonText(w.root), positions, 4));
  EXPECT_TRUE(errorMessageOf(path).starts_with("is a truncated GLB")) << errorMessageOf(path);
  w.write("model.glb", glb(1, jsonText(w.root), positions));
  EXPECT_EQ(errorMessageOf(path), "is glTF 1.0; convert it to glTF 2.0 (gltf-pipeline can)");
  // Every truncation is rejected without a crash.
  const std::vector<uint8_t> whole = glb(2, jsonText(w.root), positions);
  for (size_t size = 0; size < whole.size(); size += 5) {
    w.write("model.glb", {whole.begin(), whole.begin() + std::ptrdiff_t(size)});
    EXPECT_NE(errorMessageOf(path), "") << size;
  }
}

TEST(GltfFile, VersionsAndExtensions) {
  GltfWriter w;
  w.root["asset"]["version"] = "1.0";
  EXPECT_EQ(w.errorMessage(), "is glTF 1.0; convert it to glTF 2.0 (gltf-pipeline can)");
  w.root["asset"] = {{"version", "2.1"}};
  EXPECT_EQ(w.errorMessage(), "");
  w.root["asset"]["minVersion"] = "2.1";
  EXPECT_EQ(w.errorMessage(), "requires glTF 2.1; only 2.0 is supported");
  w.root["asset"] = {{"version", "2.0"}};
  w.root["extensionsUsed"] =
      json::array({"KHR_xmp_json_ld", "KHR_materials_unlit", "EXT_lights_ies"});
  w.load();
  ASSERT_EQ(w.warnings.size(), 1u);
  EXPECT_TRUE(w.warnings[0].ends_with(": ignored extensions: EXT_lights_ies, KHR_xmp_json_ld"));
  w.root["extensionsRequired"] = json::array({"KHR_texture_basisu"});
  EXPECT_EQ(w.errorMessage(),
            "requires the extension KHR_texture_basisu, which is not supported; convert its "
            "KTX2 textures to PNG, JPEG or WebP (`ktx extract` of KTX-Software can)");
}

TEST(GltfFile, BuffersByUri) {
  GltfWriter w;
  addTriangle(w);
  w.save();
  std::filesystem::create_directory(w.folder() / "sub dir");
  std::filesystem::rename(w.folder() / "data.bin", w.folder() / "sub dir" / "d\u00e9.bin");
  const auto errorMessage = [&](const std::string& uri) {
    w.root["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    std::ofstream(w.folder() / "model.gltf") << w.root;
    return errorMessageOf(w.folder() / "model.gltf");
  };
  EXPECT_EQ(errorMessage("sub dir/d\u00e9.bin"), "");
  EXPECT_EQ(errorMessage("sub%20dir/d%C3%A9.bin"), "");
  EXPECT_EQ(errorMessage("./sub%20dir/d%C3%A9.bin"), "");
  EXPECT_EQ(errorMessage("data:application/octet-stream;base64,"
                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"),
            "");
  EXPECT_EQ(errorMessage("DATA:application/octet-stream;BASE64,"
                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"),
            "");
  EXPECT_EQ(errorMessage("data:application/octet-stream;base64,"  // of %2B for +, %3D for =
                         "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAg%44%38%41AAAA%3D%3D"),
            "");
  EXPECT_EQ(errorMessage("data:application/octet-stream;base64,AA*A"),
            "buffers[0].uri: invalid data URI");
  EXPECT_EQ(errorMessage("none.bin"),
            "buffers[0].uri: " + (w.folder() / "none.bin").string() + ": no such file");
}

TEST(GltfFile, FilesOutsideTheFolderNeedPermission) {
  GltfWriter w, elsewhere;
  addTriangle(elsewhere);
  elsewhere.save();
  addTriangle(w);
  const auto errorMessage = [&](const std::string& uri, ExternalFiles external) {
    w.save();
    w.root["buffers"] = {{{"byteLength", 36}, {"uri", uri}}};
    std::ofstream(w.folder() / "model.gltf") << w.root;
    return errorMessageOf(w.folder() / "model.gltf", external);
  };
  std::filesystem::create_directory(w.folder() / "sub");
  std::filesystem::create_symlink(elsewhere.folder(), w.folder() / "link");
  std::filesystem::create_symlink("../data.bin", w.folder() / "sub/inside.bin");
  EXPECT_EQ(errorMessage("sub/inside.bin", ExternalFiles::Refuse), "");
  EXPECT_EQ(errorMessage("sub/../data.bin", ExternalFiles::Refuse), "");  // does not lead out

  const std::string other = elsewhere.folder().filename().string() + "/data.bin";
  const std::pair<std::string, const char*> outside[] = {
      {"../" + other, "is outside of the model's folder by \"..\""},
      {"sub/../../" + other, "is outside of the model's folder by \"..\""},
      {"link/../" + other, "is outside of the model's folder by \"..\""},
      {"%2e%2e/" + other, "is outside of the model's folder by \"..\""},
      {(elsewhere.folder() / "data.bin").string(), "is an absolute path"},
      {"link/data.bin", "is outside of the model's folder through a link"}};
  for (const auto& [uri, reason] : outside) {
    const std::string message = errorMessage(uri, ExternalFiles::Refuse);
    EXPECT_NE(message.find(reason), std::string::npos) << uri << ": " << message;
    EXPECT_NE(message.find("allow-external"), std::string::npos) << message;
    EXPECT_EQ(errorMessage(uri, ExternalFiles::Allow), "") << uri;
  }
  for (const char* uri : {"file:///etc/passwd", "https://example.org/x.bin", "C:/x"})
    EXPECT_NE(errorMessage(uri, ExternalFiles::Allow).find("has the scheme"), std::string::npos)
        << uri;
  EXPECT_EQ(errorMessage("data%3ax", ExternalFiles::Allow).find("scheme"),  // a file `data:x`
            std::string::npos);
  for (const char* uri : {"..\\x", "a\nb", "%00"})
    EXPECT_NE(errorMessage(uri, ExternalFiles::Allow).find("backslash or a control"),
              std::string::npos)
        << uri;
}

TEST(GltfFile, BuffersWithoutBytesAreRejectedOnlyWhenUsed) {
  GltfWriter w;
  w.root["buffers"] = {{{"byteLength", 100}}};
  EXPECT_EQ(w.errorMessage(), "");
}

TEST(GltfFile, RejectsOtherFiles) {
  GltfWriter w;
  const auto errorMessage = [&](const std::string& text) {
    w.write("x.gltf", {text.begin(), text.end()});
    return errorMessageOf(w.folder() / "x.gltf");
  };
  EXPECT_NE(errorMessage(""), "");
  EXPECT_NE(errorMessage("PNG"), "");
  EXPECT_EQ(errorMessage("[]"), "is not a JSON object");
  EXPECT_EQ(errorMessage("{}"), "has no asset.version; it must be \"2.0\"");
  const std::string deep(100000, '[');
  EXPECT_EQ(errorMessage("{\"extras\":" + deep + "}"), "nests deeper than 128 levels");
  const std::string brackets = "{\"asset\":{\"version\":\"2.0\"},\"extras\":\"\\\"" + deep + "\"}";
  EXPECT_EQ(errorMessage(brackets), "");
  EXPECT_EQ(errorMessageOf(w.folder() / "missing.gltf"), "no such file");
  EXPECT_EQ(errorMessageOf(w.folder()), "not a regular file");
}

TEST(GltfFile, LongNamesAndListsAreShortened) {
  GltfWriter w;
  addTriangle(w);
  for (int i = 0; i < 1000; ++i)
    w.root["extensionsUsed"].push_back(fmt::format("FOO{:03}", i) + std::string(5000, ' '));
  w.load();
  ASSERT_EQ(w.warnings.size(), 1u);
  EXPECT_LE(w.warnings[0].size(), 6 * 202u + 200);
  EXPECT_TRUE(w.warnings[0].ends_with(" and 994 more")) << w.warnings[0];
  for (const std::string& part : {std::string("a"), std::string("a ")}) {
    std::string uri;
    while (uri.size() < 100000) uri += part;
    w.root["buffers"][0]["uri"] = uri;
    std::ofstream(w.folder() / "model.gltf") << w.root;
    const std::string message = errorMessageOf(w.folder() / "model.gltf");
    EXPECT_TRUE(message.starts_with("buffers[0].uri: \"a")) << message;
    EXPECT_TRUE(message.ends_with("\" cannot be found: File name too long")) << message;
    EXPECT_LE(message.size(), 300u);
  }
}

TEST(GltfFile, MessagesStayOnOneLine) {
  GltfWriter w;
  w.root["extensionsRequired"] = json::array({"A\nB"});
  EXPECT_TRUE(w.errorMessage().starts_with("requires the extension A B, which"))
      << w.errorMessage();
}

TEST(SlowGltfFile, RejectsAmplificationByReferences) {
  // 2000 primitives that all read the same 100 kB.
  GltfWriter w;
  const int positions = w.vec3s(std::vector<float>(3 * 9000, 0.0f));
  std::vector<json> primitives;
  for (int i = 0; i < 2000; ++i) {
    const json accessor = w.root["accessors"][positions];
    primitives.push_back({{"attributes", {{"POSITION", w.add("accessors", accessor)}}}});
  }
  w.add("meshes", {{"primitives", primitives}});
  w.add("nodes", {{"mesh", 0}});
  EXPECT_NE(w.errorMessage().find("out of proportion to the length"), std::string::npos);
}

// Also of points, of which there is no geometry; and joints, of each primitive that has a skin.
TEST(SlowGltfFile, RejectsManyPrimitivesOfManyNodesAndJoints) {
  constexpr int kMany = 3000;
  GltfWriter points;
  const int position = points.vec3s({0, 0, 0});
  points.add("meshes",
             {{"primitives",
               std::vector<json>(kMany, {{"mode", 0}, {"attributes", {{"POSITION", position}}}})}});
  for (int i = 0; i < kMany; ++i) points.add("nodes", {{"mesh", 0}});
  EXPECT_NE(points.errorMessage().find("out of proportion to the length"), std::string::npos);

  GltfWriter skinned;
  const int joints = skinned.accessor(skinned.view(std::vector<uint8_t>(12, 0)), kUByte, "VEC4", 3);
  const int weights = skinned.accessor(
      skinned.view(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kFloat, "VEC4", 3);
  addTriangle(skinned, {{"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}},
              {{"skin", 0}});
  json& primitives = skinned.root["meshes"][0]["primitives"];
  primitives = std::vector<json>(kMany, primitives[0]);
  skinned.add("skins", {{"joints", std::vector<int>(kMany, skinned.add("nodes", json::object()))}});
  EXPECT_NE(skinned.errorMessage().find("out of proportion to the length"), std::string::npos);
}

TEST(GltfFile, SkinsWithoutJointsAreNamedInTheMessage) {
  GltfWriter w;
  addTriangle(w);
  w.add("skins", json::object());
  EXPECT_EQ(w.errorMessage(), "skins[0].joints: is missing");
}

}  // namespace
}  // namespace chromeball::gltf_file_test
