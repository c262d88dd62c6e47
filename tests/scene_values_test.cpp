// SPDX-License-Identifier: Apache-2.0
// Scenes, cameras and settings from values in memory; scenes of arrays with and without models.
#include "front/scene_values.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/json.h"
#include "front/plan_render.h"
#include "paths.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "session/session.h"
#include "test_scene.h"

namespace chromeball::scene_values_test {
namespace {

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::string kModel = std::string(kSourceDir) + "/scenes/models/still-life.glb";

TEST(SceneValues, AreReadAsASceneFile) {
  const SceneFile scene = sceneOf(
      toml::table{
          {"model", kModel},
          {"render", toml::table{{"samples", 3}, {"size", toml::array{40, 30}}}},
          {"light", toml::array{toml::table{
                        {"type", "point"}, {"position", toml::array{0, 1, 0}}, {"power", 2.5}}}}},
      "the scene");
  EXPECT_EQ(scene.models.at(0).file, kModel);
  EXPECT_EQ(scene.settings.get<uint64_t>("render.samples"), 3u);
  EXPECT_EQ(scene.lamps.size(), 1u);
  EXPECT_TRUE(sceneOf({}, "the scene").models.empty());
}

// A value from memory has no line.
TEST(SceneValues, ErrorsBeginWithTheName) {
  const auto error = [](toml::table table) {
    return errorOf([&] { sceneOf(std::move(table), "the scene"); });
  };
  EXPECT_EQ(error(toml::table{{"render", toml::table{{"sampels", 3}}}})
                .find("the scene: unknown key `sampels"),
            0u);
  EXPECT_EQ(error(toml::table{{"render", toml::table{{"samples", "3"}}}})
                .find("the scene: `samples` must be"),
            0u);
  EXPECT_EQ(error(toml::table{{"light", toml::array{toml::table{{"type", "point"}, {"angle", 3}}}}})
                .find("the scene: a point light has no `angle`"),
            0u);
  EXPECT_NE(error(toml::table{{"model", "none.glb"}}).find("relative to the working folder"),
            std::string::npos);
}

TEST(SceneValues, KeywordsAreOptionsWithTheirChecks) {
  const Settings settings = keywordSettings(
      toml::table{{"max_depth", 3}, {"layers", toml::array{"depth"}}, {"probe_rotation", 40}},
      "render()");
  EXPECT_EQ(settings.get<uint64_t>("render.max_depth"), 3u);
  EXPECT_EQ(settings.get<std::vector<std::string>>("output.aovs"),
            std::vector<std::string>{"depth"});
  EXPECT_EQ(settings.get<std::vector<double>>("probe.rotation"), std::vector<double>{40});
  const auto error = [](toml::table table) {
    return errorOf([&] { keywordSettings(table, "render()"); });
  };
  EXPECT_EQ(error(toml::table{{"max_dept", 3}}).find("render(): unknown keyword `max_dept`"), 0u);
  EXPECT_NE(error(toml::table{{"max_dept", 3}}).find("max_depth"), std::string::npos);
  EXPECT_NE(error(toml::table{{"max_depth", -1}}).find("must be"), std::string::npos);
  EXPECT_NE(error(toml::table{{"output", "a.exr"}}).find("unknown keyword"), std::string::npos);
  // What a render by keywords cannot honour.
  EXPECT_EQ(error(toml::table{{"plate", "a.png"}}),
            "render(): unknown keyword `plate`; it is a key of [composite]: give it in the scene");
  EXPECT_NE(error(toml::table{{"radius", 3}}).find("[[light]]"), std::string::npos);
  EXPECT_EQ(error(toml::table{{"noise_map", "a.png"}}),
            "render(): unknown keyword `noise_map`; it is an option of the command alone");
  for (const std::string_view keyword : keywords())
    EXPECT_FALSE(findKeyword(keyword)->option.empty()) << keyword;
}

// A new option of the command is a keyword, or is listed as the command's own.
TEST(SceneValues, EverySettingOfAnImageHasAKeyword) {
  for (const Setting& setting : settingTable()) {
    if (setting.option.empty() || setting.effect == Effect::Run || setting.name() == "shard" ||
        setting.type == SettingType::Compound || setting.name() == "camera.name")
      continue;
    const std::string keyword = keywordOf(setting.name());
    EXPECT_EQ(findKeyword(keyword), &setting) << setting.name();
  }
  EXPECT_EQ(findKeyword("no such"), nullptr);
  EXPECT_EQ(keywordOf("checkpoint"), "checkpoint");
}

TEST(SceneValues, ACameraReplacesTheScenes) {
  SceneFile scene = sceneOf(
      toml::table{{"camera", toml::table{{"name", "Front"}, {"aperture", 0.1}, {"focus", 2}}}},
      "the scene");
  replaceCamera(scene,
                toml::table{{"position", toml::array{0, 0, 3}}, {"look_at", toml::array{0, 0, 0}}},
                "the camera");
  EXPECT_FALSE(scene.settings.has("camera.name"));
  EXPECT_FALSE(scene.lens);
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->position.z, 3);
  EXPECT_EQ(errorOf([&] {
              replaceCamera(scene, toml::table{{"fow", 3}}, "the camera");
            }).find("the camera: unknown key `fow`"),
            0u);
}

TEST(SceneValues, AProbeFromMemoryHasAnyMapping) {
  const Image latLong = gradientProbe({64, 32}, Rgb(0.5f), {0.1, 0.3, 0.2});
  const Image angular = convert(latLong, Mapping::LatLong, Mapping::AngularMap, {64, 64});
  const LoadedProbe probe = loadProbe(angular, "angular", "mapping", "the array");
  EXPECT_EQ(probe.mapping, Mapping(Mapping::AngularMap));
  EXPECT_EQ(probe.latLong.texels, convert(angular, Mapping::AngularMap, Mapping::LatLong,
                                          latLongSize(Mapping::AngularMap, {64, 64}))
                                      .texels);
  Image invalid = latLong;
  invalid.at(5, 7)[1] = NAN;
  EXPECT_EQ(errorOf([&] { loadProbe(invalid, "auto", "mapping", "the array"); }),
            "the array: texel 5, 7 must be finite, and not negative");
  EXPECT_NE(errorOf([&] { loadProbe(Image(4, 2, 4), "auto", "mapping", "the array"); }), "");
  EXPECT_NE(errorOf([&] { loadProbe(latLong, "angluar", "mapping", "the array"); }), "");
}

RenderDescription described(bool hasModel, bool hasArrays) {
  SceneFile file = sceneOf({}, "the scene");
  if (hasModel) file.models.push_back({kModel, {}, {}});
  RenderDescription description = planRender(std::move(file));
  if (hasArrays) {
    auto scene = std::make_shared<Scene>();
    addQuad(*scene, addMaterial(*scene, lambert(Rgb(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    description.scene = scene;
  }
  description.probe.map = std::make_shared<const Image>(constantProbe({16, 8}, Rgb(1)));
  description.size = ImageSize{8, 8};
  description.settings.samples = 2;
  return description;
}

size_t trianglesOf(const RenderDescription& description) {
  Session session(description);
  session.start();
  const nlohmann::json statistics = nlohmann::json::parse(session.wait().statistics);
  EXPECT_GE(statistics.at("seconds").at("load"), 0);
  EXPECT_EQ(statistics.at("width"), 8);
  EXPECT_EQ(session.snapshot()->statistics, session.wait().statistics);
  return statistics.at("triangles");
}

TEST(SceneValues, ModelsAndArraysAreOneScene) {
  const size_t model = trianglesOf(described(true, false));
  EXPECT_EQ(trianglesOf(described(false, true)), 2u);
  EXPECT_EQ(trianglesOf(described(true, true)), model + 2);
  Session session(described(false, false));
  session.start();
  EXPECT_NE(errorOf([&] { session.wait(); }).find("no triangles"), std::string::npos);
}

}  // namespace
}  // namespace chromeball::scene_values_test
