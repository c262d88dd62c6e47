// SPDX-License-Identifier: Apache-2.0
// Parts of the light: `--light-from`, `probe split` and `probe add-sun`, lists read by [[light]].
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "lighting/export/light_file.h"
#include "math/icosphere.h"
#include "measure/statistics.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/render_loaded.h"
#include "shared_data.h"
#include "small_model.h"
#include "test_scene.h"

namespace chromeball::light_from_test {
namespace {

// A sky with a sun of 3 degrees; the texels have 0.7.
Image skyWithSun() {
  Image map = gradientProbe({512, 256}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1});
  addSunDisc(map, glm::normalize(dvec3(0.3, 0.5, 0.6)), 3, dvec3(9, 8, 6));
  return map;
}

// A white triangle that faces +Z, in a folder of its own.
class WhiteFloor {
 public:
  explicit WhiteFloor(const std::string& scene) {
    writer_.add("materials",
                {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                 {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    addTriangle(writer_, {{"material", 0}});
    writer_.save();
    std::ofstream(*this / "a.toml") << "model = 'model.gltf'\n" << scene;
  }
  std::string operator/(const std::string& name) const { return writer_.folder() / name; }

 private:
  GltfWriter writer_;
};

// Lit by the probe, a sun, a point light and a disc.
WhiteFloor litFloor() {
  return WhiteFloor(
      "[camera]\nposition = [0.3, 0.3, 1]\nlook_at = [0.3, 0.3, 0]\nfov = 60\n"
      "[probe]\nfile = 'sky.exr'\n"
      "[[light]]\ndirection = [0.2, -0.6, 0.8]\nirradiance = [1, 2, 3]\nangle = 5\n"
      "[[light]]\ntype = 'point'\nposition = [0, 0, 0.5]\nintensity = 0.1\n"
      "[[light]]\ntype = 'disc'\nposition = [0.5, 0.3, 0.5]\ndirection = [0, 0, -1]\n"
      "radius = 0.1\nradiance = [3, 2, 1]\n[render]\nsize = [16, 8]\n");
}

// Sums of tiles of 4 x 4 pixels, [tile].
std::vector<double> tileSums(const WhiteFloor& folder, const std::string& strategy,
                             const std::string& part, uint64_t seed) {
  SceneFile file = readSceneFile(folder / "a.toml");
  file.settings.set("render.samples", uint64_t(16));
  file.settings.set("render.seed", seed);
  file.settings.set("lighting.strategy", strategy);
  file.settings.set("lighting.from", part);
  file.settings.set("output.file", std::vector<std::string>{folder / "o.exr"});
  RenderDescription description = planRender(file);
  const LoadedScene loaded = loadScene(description);
  const FinishedRender result = renderLoaded(loaded);
  std::vector<double> sums(8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      sums[size_t(y / 4 * 4 + x / 4)] += luminance(result.color().rgb(x, y));
  return sums;
}

// Independent renders of the parts and of the whole: Welch's test of each tile, Sidak's correction
// over the tiles of both strategies.
TEST(SlowLightFrom, SunsAndRestAddUpToTheWhole) {
  const WhiteFloor folder = litFloor();
  writeImage(folder / "sky.exr", skyWithSun());
  constexpr int kRepeats = 12, kTiles = 8;
  for (const char* strategy : {"importance", "suns"}) {
    std::vector<std::vector<double>> whole(kTiles), parts(kTiles);
    double suns = 0, rest = 0;
    for (uint64_t i = 0; i < kRepeats; ++i) {
      const auto all = tileSums(folder, strategy, "all", 3 * i);
      const auto some = tileSums(folder, strategy, "suns", 3 * i + 1);
      const auto others = tileSums(folder, strategy, "rest", 3 * i + 2);
      for (size_t t = 0; t < kTiles; ++t) {
        whole[t].push_back(all[t]);
        parts[t].push_back(some[t] + others[t]);
        suns += some[t], rest += others[t];
      }
    }
    for (size_t t = 0; t < kTiles; ++t)
      EXPECT_GT(welchTest(Moments::of(whole[t]), Moments::of(parts[t])), sidak(1e-3, 2 * kTiles))
          << strategy << ", tile " << t << ": " << Moments::of(whole[t]).mean << " and "
          << Moments::of(parts[t]).mean;
    EXPECT_GT(suns, 0.2 * rest);
    EXPECT_GT(rest, 0.2 * suns);
  }
}

TEST(LightFrom, RefusesAWholeWithoutSuns) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  writeImage(folder / "grey.exr", constantProbe({16, 8}, Rgb(1)));
  const std::vector<std::string> command{
      "render", folder / "model.gltf", "--probe", folder / "grey.exr", "-o", folder / "o.exr"};
  auto suns = command;
  suns.insert(suns.end(), {"--light-from", "suns"});
  expectError(suns, "there are no suns");
  auto sun = command;
  sun.insert(sun.end(), {"--light-from", "sun"});
  expectError(sun, "`suns`");
  EXPECT_FALSE(std::filesystem::exists(folder / "o.exr"));
}

// What is missing are suns, whatever else lights the scene.
TEST(LightFrom, SaysThatThereAreNoSuns) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  for (const char* lamp :
       {"", "[[light]]\ntype = 'point'\nposition = [0, 2, 0]\nintensity = 1\n",
        "[[light]]\ntype = 'disc'\nposition = [0, 2, 0]\ndirection = [0, -1, 0]\n"
        "radius = 1\nradiance = 1\n"}) {
    std::ofstream(folder / "scene.toml") << "model = 'model.gltf'\n" << lamp;
    expectError({"render", folder / "scene.toml", "--light-from", "suns", "-o", folder / "o.exr"},
                "--light-from: there are no suns, neither in the probe nor in the scene file");
  }
  const auto model = sharedData("gltf/LightsPunctualLamp/glTF/LightsPunctualLamp.gltf");
  if (model)
    expectError({"render", model->string(), "--light-from", "suns", "-o", folder / "o.exr"},
                "there are no suns");
}

// The lamps of the scene file are left out, and no lamp of the model is counted.
TEST(LightFrom, SunsWithoutAProbeCountNoLamps) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  std::ofstream(folder / "scene.toml")
      << "model = \"model.gltf\"\n[[light]]\ntype = \"point\"\nposition = [0, 2, 0]\n"
         "intensity = 1\n[[light]]\ntype = \"sun\"\ndirection = [0, 1, 0]\nirradiance = 1\n";
  const CommandResult result =
      runCommand({"render", folder / "scene.toml", "--light-from", "suns", "--size", "8x8",
                  "--samples", "2", "-o", folder / "o.exr"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error.find("lit by the model's"), std::string::npos) << result.error;
}

void expectSameIrradiance(const Image& a, const Image& b, const std::string& name) {
  const std::vector<vec3> normals = icosphereNormals(2);
  const std::vector<dvec3> ofA = exactIrradiance(a, normals), ofB = exactIrradiance(b, normals);
  dvec3 mean(0);
  for (const dvec3& e : ofA) mean += e / double(normals.size());
  for (size_t i = 0; i < normals.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(ofB[i][k], ofA[i][k], 1e-3 * mean[k]) << name;
}

// Splitting a probe and drawing its suns again keeps the irradiance of all normals, to 0.1% of the
// mean.
TEST(SlowProbeSplit, AndAddSunKeepTheIrradiance) {
  const TemporaryFolder folder;
  std::vector<std::string> probes{folder / "sky.exr"};
  writeImage(probes.front(), skyWithSun());
  for (const char* name : {"qwantani_afternoon_puresky_1k.hdr", "kloppenheim_05_1k.hdr"})
    if (const auto path = sharedData("probes/polyhaven/" + std::string(name)))
      probes.push_back(path->string());
  for (const std::string& probe : probes) {
    const CommandResult split = runCommand(
        {"probe", "split", probe, "--suns", folder / "suns.json", "--rest", folder / "rest.exr"});
    ASSERT_EQ(split.status, 0) << split.error;
    EXPECT_NE(split.out.find("suns        1\n"), std::string::npos) << split.out;
    const CommandResult add = runCommand({"probe", "add-sun", folder / "rest.exr",
                                          folder / "back.exr", "--lights", folder / "suns.json"});
    ASSERT_EQ(add.status, 0) << add.error;
    const LightList list = readLights(folder / "suns.json");
    ASSERT_EQ(list.lights.size(), 1u);
    expectSameIrradiance(loadProbe(probe, "auto", "test").latLong, readImage(folder / "back.exr"),
                         probe);
  }
}

// By its shape a map of 96 x 64 texels would be one of six faces.
TEST(ProbeSplit, AndAddSunNameTheMapping) {
  const TemporaryFolder folder;
  Image map = gradientProbe({96, 64}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1});
  addSunDisc(map, glm::normalize(dvec3(0.3, 0.5, 0.6)), 10, dvec3(9, 8, 6));
  writeImage(folder / "sky.exr",
             OutputImage{{{"", "RGB", map}}, {{kMappingAttribute, std::string("lat-long")}}});
  for (const char* extension : {".exr", ".hdr"}) {
    const std::string rest = folder / ("rest" + std::string(extension)),
                      back = folder / ("back" + std::string(extension));
    ASSERT_EQ(runCommand({"probe", "split", folder / "sky.exr", "--suns", folder / "suns.json",
                          "--rest", rest})
                  .status,
              0);
    ASSERT_EQ(runCommand({"probe", "add-sun", rest, back, "--lights", folder / "suns.json"}).status,
              0);
    EXPECT_EQ(loadProbe(rest).mapping, Mapping::LatLong);
    EXPECT_EQ(loadProbe(back).mapping, Mapping::LatLong);
  }
  const CommandResult lost = runCommand({"probe", "add-sun", folder / "rest.exr",
                                         folder / "back.pfm", "--lights", folder / "suns.json"});
  EXPECT_NE(lost.error.find("has no place for its mapping, lat-long"), std::string::npos);
}

TEST(ProbeSplit, WritesTheDiameterThatIsAskedFor) {
  const TemporaryFolder folder;
  writeImage(folder / "sky.exr", skyWithSun());
  const auto split = [&](const std::string& angle) {
    return runCommand({"probe", "split", folder / "sky.exr", "--suns", folder / "suns.json",
                       "--rest", folder / "rest.exr", "--angle", angle});
  };
  ASSERT_EQ(split("0.5323").status, 0);
  EXPECT_FLOAT_EQ(readLights(folder / "suns.json").lights.front().angle, 0.5323f);
  EXPECT_EQ(split("0.001").status, 2);
  EXPECT_EQ(split("91").status, 2);
  expectError({"probe", "split", folder / "sky.exr", "--suns", folder / "suns.csv", "--rest",
               folder / "rest.exr"},
              ".json");
}

LightList listOf(const TemporaryFolder& folder, const std::string& json) {
  std::ofstream(folder / "l.json") << json;
  return readLights(folder / "l.json");
}

TEST(LightList, ReadsWhatIsWritten) {
  const TemporaryFolder folder;
  const LightRig rig{
      .probe = "p",
      .method = "m",
      .ambient = Rgb(0.1f, 1e-8f, 1e10f),
      .lights = {{{0, 0.6f, 0.8f}, {1, 2, 3}, 0}, {{1, 0, 0}, {1e-8f, 0, 1e10f}, 2}}};
  writeLights(folder / "l.json", rig);
  const LightList list = readLights(folder / "l.json");
  ASSERT_EQ(list.lights.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(list.lights[i].irradiance, rig.lights[i].irradiance);
    EXPECT_EQ(list.lights[i].angle, rig.lights[i].angle);
    EXPECT_LT(glm::distance(list.lights[i].direction, rig.lights[i].direction), 1e-6f);
  }
  EXPECT_EQ(list.ambient, rig.ambient);
}

TEST(LightList, ReadsWhatWasEdited) {
  const TemporaryFolder folder;
  const LightList list = listOf(
      folder, R"({"lights": [{"direction": [0, 0, 5], "radiance": [1, 1, 2], "angle": 1}]})");
  EXPECT_EQ(list.lights.front().direction, vec3(0, 0, 1));
  EXPECT_NEAR(list.lights.front().irradiance.z, 2 * 2.3925e-4, 1e-7);
}

TEST(LightList, RefusesOthers) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& json, const std::string& reason) {
    try {
      listOf(folder, json);
      ADD_FAILURE() << json;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  const auto light = [](const std::string& members) { return "{\"lights\": [{" + members + "}]}"; };
  refused("", "l.json:1: is not valid JSON here");
  refused("{\n\"lights\": [\n{]}", "l.json:3: is not valid JSON here");
  refused("[1, 2]", "object");
  refused("{}", "`lights`");
  refused(R"({"lights": [3]})", "lights[0]");
  refused(light(R"("irradiance": [1, 1, 1])"), "direction");
  refused(light(R"("direction": [0, 0, 0], "irradiance": [1, 1, 1])"), "direction");
  refused(light(R"("direction": [0, 1, 0])"), "neither");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1, -1, 1])"), "negative");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1, 1e39, 1])"), "three numbers");
  refused(light(R"("direction": [0, 1, 0], "irradiance": ["1", 1, 1])"), "three numbers");
  refused(light(R"("direction": [0, 1, 0], "radiance": [1, 1, 1])"), "angle");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1e38, 1, 1], "angle": 0.01)"),
          "too large");
  for (const char* angle : {"1e-30", "0.009", "-1", "\"1\""})
    refused(
        light(std::string(R"("direction": [0, 1, 0], "irradiance": [1, 1, 1], "angle": )") + angle),
        "`angle` should be 0, or 0.01 to 90");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1, 1, 1], "diameter": 1)"),
          "`diameter` is no key");
  refused(R"({"lights": [], "ambiance": [1, 1, 1]})", "`ambiance` is no key");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1, 1, 1], "angle": 100)"), "angle");
  refused(light(R"("direction": [0, 1, 0], "irradiance": [1, 1, 1], "radiance": [9, 9, 9],
                   "angle": 1)"),
          "one of the three was edited");
}

// A light without an angle, one of 20 degrees and ambient light, on a white floor that faces +Z
// give L = (E1 cos1 + E2 cos2) / pi + ambient.
TEST(LightList, LightsAScene) {
  const WhiteFloor folder(
      "[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\nfov = 2\n"
      "[[light]]\nfile = 'l.json'\n");
  writeLights(folder / "l.json",
              {.probe = "p",
               .method = "m",
               .ambient = Rgb(0.3f, 0.2f, 0.1f),
               .lights = {{{0, 0.6f, 0.8f}, {1, 2, 3}, 0}, {{0, -0.6f, 0.8f}, {3, 2, 1}, 20}}});
  const CommandResult result =
      runCommand({"render", folder / "a.toml", "--size", "4x4", "--samples", "256", "--max-depth",
                  "1", "-o", folder / "o.exr"});
  ASSERT_EQ(result.status, 0) << result.error;
  const Rgb color = meanColor(readImage(folder / "o.exr"));
  EXPECT_NEAR(color.x, 4 * 0.8 / kPiD + 0.3, 5e-3);
  EXPECT_NEAR(color.y, 4 * 0.8 / kPiD + 0.2, 5e-3);
  EXPECT_NEAR(color.z, 4 * 0.8 / kPiD + 0.1, 5e-3);
}

}  // namespace
}  // namespace chromeball::light_from_test
