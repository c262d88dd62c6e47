// SPDX-License-Identifier: Apache-2.0
// Suns that a scene has besides its probe: [[light]] without a type, or of type sun.
#include "hypothesis.h"
#include "lighting/scene_sources.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/render_loaded.h"
#include "small_model.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_scene.h"
#include "transport/path_settings.h"

namespace chromeball::scene_suns_test {
namespace {

const dvec3 kDirection = glm::normalize(dvec3(0.748, 0.199, 0.633));

SceneFile read(const TemporaryFolder& folder, const std::string& toml) {
  writeSmallModel(folder / "model.gltf");
  std::ofstream(folder / "a.toml") << "model = 'model.gltf'\n" << toml;
  return readSceneFile(folder / "a.toml");
}

TEST(SceneSuns, AreReadFromTheSceneFile) {
  const TemporaryFolder folder;
  const SceneFile file = read(folder,
                              "[[light]]\ndirection = [0.748, 0.199, 0.633]\nangle = 0.5323\n"
                              "radiance = [54500, 45400, 32700]\n"
                              "[[light]]\ntype = 'sun'\ndirection = [0, 2, 0]\nirradiance = 3\n"
                              "visible = false\n");
  ASSERT_EQ(file.lamps.size(), 2u);
  const SunLamp& first = *file.lamps[0].sun;
  EXPECT_LT(glm::distance(first.sun.direction, kDirection), 1e-6);
  // E = pi sin^2(angle / 2) L
  const double sine = std::sin(0.5323 / 2 * kPiD / 180);
  EXPECT_NEAR(first.sun.irradiance.x / (kPiD * sine * sine * 54500), 1, 1e-6);
  EXPECT_TRUE(first.isVisible);
  const SunLamp& second = *file.lamps[1].sun;
  EXPECT_EQ(second.sun.angle, kSunDiameter);
  EXPECT_LT(glm::distance(second.sun.irradiance, dvec3(3)), 1e-6);
  EXPECT_FALSE(second.isVisible);
}

TEST(SceneSuns, ListsTurnLikeProbes) {
  const TemporaryFolder folder;
  std::ofstream(folder / "l.json")
      << R"({"lights": [{"direction": [0, 0.6, 0.8], "irradiance": [3, 2, 1], "angle": 1},
                        {"direction": [1, 0, 0], "irradiance": [1, 1, 1]}]})";
  const SceneFile file = read(folder, "[[light]]\nfile = 'l.json'\nrotation = [70, 20, 10]\n");
  const Rotation rotation = Rotation::ofAngles({70, 20, 10});
  ASSERT_EQ(file.lamps.size(), 2u);
  EXPECT_LT(glm::distance(file.lamps[0].sun->sun.direction, rotation(dvec3(0, 0.6, 0.8))), 1e-6);
  EXPECT_LT(glm::distance(dvec3(file.lamps[1].punctual->direction), rotation(dvec3(-1, 0, 0))),
            1e-6);
  EXPECT_THROW(read(folder, "[[light]]\nfile = 'l.json'\nrotation = [1, 2]\n"), InputError);
  EXPECT_THROW(read(folder, "[[light]]\ndirection = [0, 1, 0]\nradiance = 1\nrotation = 5\n"),
               InputError);
}

TEST(SceneSuns, RefusesWhatIsNoSun) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& keys, const std::string& reason) {
    writeSmallModel(folder / "model.gltf");
    std::ofstream(folder / "a.toml") << "model = 'model.gltf'\n[[light]]\n" << keys;
    expectError({"render", folder / "a.toml", "-o", folder / "o.exr"}, reason);
  };
  refused("radiance = 1\n", "direction");
  refused("direction = [0, 1, 0]\n", "either `radiance` or `irradiance`");
  refused("direction = [0, 1, 0]\nradiance = 1\nirradiance = 1\n", "either");
  refused("direction = [0, 0, 0]\nradiance = 1\n", "must not be 0");
  refused("direction = [0, 1, 0]\nradiance = 1\nangle = 0\n", "angle");
  refused("direction = [0, 1, 0]\nradiance = -1\n", "radiance");
  refused("direction = [0, 1, 0]\nangle = 0.01\nirradiance = 1e36\n",
          "a.toml:5: the sun's radiance");
  refused("direction = [0, 1, 0]\nradiance = 1\nposition = [0, 0, 0]\n", "position");
  EXPECT_FALSE(std::filesystem::exists(folder / "o.exr"));
}

// Two suns over a sky, one of them invisible, both wide enough to overlap the tests' bins.
std::vector<SunLamp> wideSuns() {
  return {{{glm::normalize(dvec3(0.3, 1, 0.2)), dvec3(3, 2, 1), 25}, true},
          {{glm::normalize(dvec3(-0.5, 1, 0.1)), dvec3(1, 2, 3), 30}, false}};
}

TEST(SceneSuns, PdfIsTheMixtureOfAllSamples) {
  const SceneSuns suns(wideSuns());
  Samples samples(suns, {0, 1, 0});
  const auto draw = [&](int i) -> std::optional<vec3> {
    const auto& taken = samples.take(i / 2);
    EXPECT_EQ(taken.size(), 2u);
    const DirectionSample& s = taken[size_t(i % 2)];
    const auto escaped = suns.escaped(samples.point(), s.wi);
    EXPECT_NEAR(s.pdf / escaped.pdf, 1, 1e-5);
    EXPECT_NEAR(s.irradiance.x * s.pdf / escaped.radiance.x, 1, 1e-5);
    return s.wi;
  };
  const SphereTest test = testDirections(
      draw, [&](const vec3& wi) { return suns.escaped(samples.point(), wi).pdf / 2; }, 60000);
  EXPECT_NEAR(test.totalProbability, 1, 2e-3);
  EXPECT_GT(test.chiSquare.pValue, 1e-3);
}

// Light samples and BSDF samples together give the exact irradiance.
TEST(SceneSuns, GiveTheirIrradiance) {
  const vec3 normal = glm::normalize(vec3(0.2f, 0.9f, -0.3f));
  const Frame frame(normal);
  double expected = 0;
  for (const SunLamp& lamp : wideSuns())
    expected += luminance(Rgb(lamp.sun.irradianceOn(dvec3(normal))));
  const SceneSuns suns(wideSuns());
  Samples samples(suns, normal);
  std::vector<double> estimates;
  for (int i = 0; i < 20000; ++i) {
    double sum = 0;
    for (const DirectionSample& s : samples.take(i)) {
      const float cosine = std::max(0.0f, glm::dot(normal, s.wi));
      sum +=
          luminance(s.irradiance) * cosine * lightSampleWeight(Mis::Balance, s.pdf, cosine / kPi);
    }
    const vec3 wi = frame.toWorld(squareToCosineHemisphere(random2(i, 0)));
    const float pdf = std::max(1e-6f, glm::dot(normal, wi) / kPi);
    const auto escaped = suns.escaped(samples.point(), wi);
    sum += kPi * luminance(escaped.radiance) * bsdfSampleWeight(Mis::Balance, pdf, escaped.pdf);
    estimates.push_back(sum);
  }
  const Moments moments = Moments::of(estimates);
  EXPECT_GT(tTest(moments, expected), 1e-3) << moments.mean << " and " << expected;
}

TEST(SceneSuns, TheCameraSeesTheVisibleOnes) {
  const SceneSuns suns(wideSuns());
  const auto seen = [&](size_t i) {
    return suns.background({}, vec3(wideSuns()[i].sun.direction)).x;
  };
  EXPECT_NEAR(seen(0) / wideSuns()[0].sun.radiance().x, 1, 1e-5);
  EXPECT_EQ(seen(1), 0);
  EXPECT_EQ(suns.background({}, {0, -1, 0}), Rgb(0));
}

// Lobes that are too narrow for the lights of a constellation see the probe instead of them, but
// are lit by the scene's suns and ambient light, visible or not, like all others.
TEST(SlowSceneSuns, GiveHighlightsUnderEveryStrategy) {
  GltfWriter w;
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.4}}}});
  addTriangle(w, {{"material", 0}});  // faces +Z
  w.save();
  const std::string scene = (w.folder() / "a.toml").string(), image = w.folder() / "o.exr";
  std::ofstream(w.folder() / "l.json")
      << R"({"lights": [{"direction": [0.3, 0, 1], "irradiance": [2, 2, 2], "angle": 2}],
             "ambient": [0.1, 0.1, 0.1]})";
  const auto radiances = [&](const std::string& strategy, const char* visible) {
    std::ofstream(scene)
        << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
           "fov = 2\n[[light]]\nfile = 'l.json'\nvisible = "
        << visible << "\n";
    std::vector<double> means;
    for (int seed = 1; seed <= 6; ++seed) {
      const CommandResult result = runCommand(
          {"render", scene, "--size", "4x4", "--samples", "128", "--adaptive", "off", "--max-depth",
           "1", "--seed", std::to_string(seed), "--strategy", strategy, "-o", image});
      EXPECT_EQ(result.status, 0) << result.error;
      means.push_back(meanColor(readImage(image)).x);
    }
    return Moments::of(means);
  };
  const Moments truth = radiances("bsdf", "true");
  EXPECT_GT(truth.mean, 0.2);
  for (const char* strategy : {"importance", "median-cut:4", "median-cut-area:4"})
    for (const char* visible : {"true", "false"})
      EXPECT_GT(welchTest(radiances(strategy, visible), truth), sidak(1e-3, 6))
          << strategy << " " << visible;
}

// A white Lambertian floor under a sun of 46,700: E = pi sin^2(0.5323 / 2 degrees) 46,700 = 1.0077
// pi, so its radiance is 1.0077 cos(theta) (HDRI book, 9.3.5).
TEST(SceneSuns, AFloorThroughTheCommand) {
  GltfWriter w;
  w.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  addTriangle(w, {{"material", 0}});  // faces +Z
  w.save();
  const std::string scene = (w.folder() / "a.toml").string(), image = w.folder() / "o.exr";
  for (const char* strategy : {"importance", "bsdf", "suns", "median-cut"}) {
    std::ofstream(scene)
        << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
           "fov = 2\n[[light]]\ndirection = [0, 0.6, 0.8]\nradiance = 46700\n";
    const CommandResult result =
        runCommand({"render", scene, "--size", "4x4", "--samples", "64", "--max-depth", "1",
                    "--strategy", strategy, "-o", image});
    ASSERT_EQ(result.status, 0) << result.error;
    EXPECT_NEAR(meanColor(readImage(image)).x, 1.0077 * 0.8, 2e-3) << strategy;
  }
}

}  // namespace
}  // namespace chromeball::scene_suns_test
