// SPDX-License-Identifier: Apache-2.0
// chromeball info: what is in a model.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::command_info_test {
namespace {

using nlohmann::json;

// A triangle below a node that moves it, with one of everything that `info` tells of.
void fill(GltfWriter& w) {
  const int child = addTriangle(w, {{"material", 0}}, {{"name", "Leaf"}, {"scale", {2, 4, 1}}});
  w.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_lights_punctual",
                              "KHR_materials_variants", "EXT_of_nobody"};
  w.add("materials", {{"name", "Glass"},
                      {"alphaMode", "BLEND"},
                      {"doubleSided", true},
                      {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                      {"extensions",
                       {{"KHR_materials_transmission",
                         {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}}}});
  w.write("wood.png", kPng);
  w.add("images", {{"uri", "wood.png"}});
  w.add("textures", {{"source", 0}});
  w.add(
      "cameras",
      {{"name", "Front"}, {"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}});
  w.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 683}}};
  w.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "Day"}},
                                                                {{"name", "Night"}}};
  const int root =
      w.add("nodes", {{"name", "Trunk"}, {"translation", {10, 0, 0}}, {"children", {child}}});
  const int eye = w.add("nodes", {{"name", "Eye"}, {"camera", 0}});
  const int lamp =
      w.add("nodes", {{"name", "Bulb"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  w.root["scenes"] = {{{"nodes", {root, eye, lamp}}}};
  const int times = w.accessor(w.view(std::vector<float>{0, 2.5f}), kFloat, "SCALAR", 2);
  w.root["accessors"][size_t(times)]["min"] = {0};
  w.root["accessors"][size_t(times)]["max"] = {2.5};
  const int places = w.vec3s({0, 0, 0, 1, 0, 0});
  w.add("animations",
        {{"name", "Sway"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", child}, {"path", "translation"}}}}}}});
}

json infoOf(const std::string& path) {
  const CommandResult result = runCommand({"info", path, "--json"});
  EXPECT_EQ(result.status, 0) << result.error;
  return parseJson(result.out);
}

const json& named(const json& list, const std::string& name) {
  for (const json& element : list)
    if (element["name"] == name) return element;
  static const json kNone;
  return kNone;
}

TEST(CommandInfo, TellsWhatIsInAModel) {
  GltfWriter w;
  fill(w);
  const json info = infoOf(w.save());
  EXPECT_EQ(info["triangles"], 1);
  EXPECT_EQ(info["files"].size(), 3u);  // the model, its buffer and its image
  EXPECT_EQ(info["bounds"]["max"], (json{12, 4, 0}));

  const json& leaf = named(info["nodes"], "Leaf");
  const json& trunk = named(info["nodes"], "Trunk");
  EXPECT_EQ(info["nodes"][leaf["parent"].get<size_t>()], trunk);
  EXPECT_EQ(trunk["parent"], -1);
  EXPECT_EQ(trunk["bounds"], leaf["bounds"]);
  EXPECT_EQ(trunk["triangles"], 1);
  EXPECT_EQ(leaf["bounds"]["min"], (json{10, 0, 0}));
  EXPECT_TRUE(named(info["nodes"], "Eye")["bounds"].is_null());

  const json& glass = named(info["materials"], "Glass");
  EXPECT_EQ(glass["extensions"], json{"KHR_materials_transmission"});
  EXPECT_EQ(glass["alpha_mode"], "BLEND");
  EXPECT_TRUE(glass["double_sided"]);
  EXPECT_FALSE(glass["emits"]);
  EXPECT_EQ(glass["textures"], 2);
  EXPECT_EQ(info["textures"].size(), 1u);
  EXPECT_EQ(info["textures"][0]["width"], 2);
  EXPECT_EQ(info["textures"][0]["image"], "wood.png");

  EXPECT_NEAR(info["cameras"][0]["fov"].get<double>(), 28.648, 1e-3);
  EXPECT_EQ(info["cameras"][0]["node"], "Eye");
  EXPECT_EQ(info["lamps"][0]["type"], "point");
  EXPECT_EQ(info["lamps"][0]["intensity"], (json{1, 1, 1}));  // 683 cd, in W/sr
  EXPECT_EQ(info["animations"][0], (json{{"name", "Sway"}, {"seconds", 2.5}, {"channels", 1}}));
  EXPECT_EQ(info["variants"], (json{"Day", "Night"}));
  EXPECT_FALSE(named(info["extensions"], "EXT_of_nobody")["supported"]);
  EXPECT_TRUE(named(info["extensions"], "KHR_lights_punctual")["supported"]);
}

TEST(CommandInfo, TextShortensLongLists) {
  GltfWriter w;
  fill(w);
  const json primitive = w.root["meshes"][0]["primitives"][0];
  for (int i = 0; i < 30; ++i) {
    w.mesh(primitive);
    w.root["scenes"][0]["nodes"].push_back(
        w.add("nodes", {{"name", fmt::format("Twig {}", i)}, {"mesh", i + 1}}));
  }
  const std::string path = w.save();
  const std::string text = runCommand({"info", path}).out,
                    all = runCommand({"info", path, "--all"}).out;
  EXPECT_EQ(text.find("Twig 29"), std::string::npos);
  EXPECT_NE(text.find("  and 24 more; see --all\n"), std::string::npos) << text;
  EXPECT_NE(text.find("unsupported  EXT_of_nobody\n"), std::string::npos) << text;
  EXPECT_NE(text.find("transmission, alpha blend, double-sided, 2 textures\n"), std::string::npos);
  EXPECT_NE(all.find("Twig 29"), std::string::npos);
  EXPECT_EQ(all.find("more; see"), std::string::npos);
}

TEST(CommandInfo, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "scene.toml") << "model = \"a.glb\"\n";
  expectError({"info", folder / "scene.toml"}, "scene.toml: is no glTF model");
  EXPECT_EQ(runCommand({"info", folder / "scene.toml"}).error.find("probe"), std::string::npos);
  writeImage(folder / "sky.exr", constantProbe({8, 4}, Rgb(1)));
  expectError({"info", folder / "sky.exr"},
              "is no glTF model (.gltf, .glb); see `chromeball probe info`");
  std::filesystem::create_directory(folder / "cube");
  writeImage(folder / "cube/px.exr", constantProbe({8, 8}, Rgb(1)));
  expectError({"info", folder / "cube"}, "see `chromeball probe info`");
  expectError({"info", folder / "missing.glb"}, "missing.glb: no such file");
}

// A chain as deep as the reader allows is not walked once per node.
TEST(CommandInfo, DeepNodes) {
  GltfWriter w;
  int node = addTriangle(w);
  for (int i = 0; i < 2000; ++i) node = w.add("nodes", {{"children", {node}}});
  w.root["scenes"] = {{{"nodes", {node}}}};
  const json info = infoOf(w.save());
  EXPECT_EQ(info["nodes"].size(), 2001u);
  for (const json& n : info["nodes"]) ASSERT_EQ(n["triangles"], 1);
}

TEST(SlowCommandInfo, EverySampleModel) {
  const auto models = sharedData("gltf");
  if (!models) GTEST_SKIP() << "../shared/data/gltf is not there";
  size_t shown = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*models)) {
    if (entry.path().extension() != ".glb") continue;
    const CommandResult result = runCommand({"info", entry.path().string()});
    if (result.status == 2) continue;  // gltf_samples_test checks which are refused
    ++shown;
    EXPECT_EQ(result.status, 0) << entry.path() << result.error;
    EXPECT_LT(std::ranges::count(result.out, '\n'), 80) << entry.path();
  }
  EXPECT_GT(shown, 0u);
}

}  // namespace
}  // namespace chromeball::command_info_test
