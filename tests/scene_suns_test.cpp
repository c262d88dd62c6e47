// SPDX-License-Identifier: Apache-2.0
// Suns that a scene has besides its probe: [[light]] without a type, or of type sun.
#include "lighting/scene_suns.h"

#include <gtest/gtest.h>

#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "integrate/mis.h"
#include "job/job.h"
#include "lighting/combined_light.h"
#include "lighting/methods.h"
#include "measure/statistics.h"
#include "probe/sky.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"
#include "sphere_test.h"
#include "strategy_samples.h"
#include "test_scene.h"

namespace chromeball {
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

CombinedLight withSuns(std::unique_ptr<LightingStrategy> strategy) {
  std::vector<std::unique_ptr<LightingStrategy>> parts;
  parts.push_back(std::move(strategy));
  parts.push_back(std::make_unique<SceneSuns>(wideSuns()));
  return CombinedLight(std::move(parts));
}

TEST(SceneSuns, PdfIsTheMixtureOfAllSamples) {
  const Probe probe(gradientProbe({128, 64}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1}));
  const CombinedLight suns = withSuns(makeStrategy("importance", probe, Mis::Off, "test"));
  Samples samples(suns, {0, 1, 0});
  const auto draw = [&](int i) -> std::optional<vec3> {
    const auto& taken = samples.take(i / 3);
    EXPECT_EQ(taken.size(), 3u);
    const DirectionSample& s = taken[size_t(i % 3)];
    const auto escaped = suns.escaped(samples.point(), s.wi);
    EXPECT_NEAR(s.pdf / escaped.pdf, 1, 1e-5);
    EXPECT_NEAR(s.irradiance.x * s.pdf / escaped.radiance.x, 1, 1e-5);
    return s.wi;
  };
  const SphereTest test = testDirections(
      draw, [&](const vec3& wi) { return suns.escaped(samples.point(), wi).pdf / 3; }, 60000);
  EXPECT_NEAR(test.totalProbability, 1, 2e-3);
  EXPECT_GT(test.chiSquare.pValue, 1e-3);
}

// With every strategy, light samples and BSDF samples together add the irradiance of the suns to
// what the strategy itself gives.
TEST(SceneSuns, AddTheirIrradianceToEveryStrategy) {
  const Probe probe(gradientProbe({64, 32}, Rgb(0.4f, 0.5f, 0.7f), {0.2, 0.9, 0.1}));
  const vec3 normal = glm::normalize(vec3(0.2f, 0.9f, -0.3f));
  const Frame frame(normal);
  double expected = 0;
  for (const SunLamp& lamp : wideSuns())
    expected += luminance(Rgb(lamp.sun.irradianceOn(dvec3(normal))));
  const std::vector<std::string_view> names = strategyNames();
  for (const std::string_view name : names) {
    SCOPED_TRACE(std::string(name));
    const auto own = makeStrategy(std::string(name), probe, Mis::Balance, "test");
    const CombinedLight both =
        withSuns(makeStrategy(std::string(name), probe, Mis::Balance, "test"));
    Samples ownSamples(*own, normal), samples(both, normal);
    const auto estimate = [&](const LightingStrategy& lighting, Samples& of, int i) {
      double sum = 0;
      for (const DirectionSample& s : of.take(i)) {
        const float cosine = std::max(0.0f, glm::dot(normal, s.wi));
        const float weight = s.isDelta ? 1 : misWeight(Mis::Balance, s.pdf, cosine / kPi);
        sum += luminance(s.irradiance) * cosine * weight;
      }
      const vec3 wi = frame.toWorld(squareToCosineHemisphere(random2(i, 0)));
      const float pdf = std::max(1e-6f, glm::dot(normal, wi) / kPi);
      const auto escaped = lighting.escaped(of.point(), wi);
      return sum +
             kPi * luminance(escaped.radiance) * bsdfSampleWeight(Mis::Balance, pdf, escaped.pdf);
    };
    std::vector<double> differences;  // with the same random numbers
    for (int i = 0; i < 20000; ++i)
      differences.push_back(estimate(both, samples, i) - estimate(*own, ownSamples, i));
    const Moments moments = Moments::of(differences);
    EXPECT_GT(tTest(moments, expected), sidak(1e-3, int(names.size())))
        << moments.mean << " and " << expected;
  }
}

TEST(SceneSuns, TheCameraSeesTheVisibleOnes) {
  const Probe black(Image(2, 1, 3));
  const CombinedLight suns = withSuns(makeStrategy("importance", black, Mis::Balance, "test"));
  const auto seen = [&](size_t i) {
    return suns.background({}, vec3(wideSuns()[i].sun.direction)).x;
  };
  EXPECT_NEAR(seen(0) / wideSuns()[0].sun.radiance().x, 1, 1e-5);
  EXPECT_EQ(seen(1), 0);
  EXPECT_EQ(suns.background({}, {0, -1, 0}), Rgb(0));
}

// A white Lambertian floor under a sun of 46,700: E = pi sin^2(0.5323 / 2 degrees) 46,700 = 1.0077
// pi, so its radiance is 1.0077 cos(theta) (HDRI book, 9.6.1).
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
}  // namespace chromeball
