// SPDX-License-Identifier: Apache-2.0
// The presets of `quality`, and what the settings beside them change.
#include "front/quality.h"

#include <gtest/gtest.h>

#include <fstream>

#include "description/capabilities.h"
#include "front/plan_render.h"
#include "image/io/read_image.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::quality_test {
namespace {

RenderDescription planned(const Settings& file, const Settings& over) {
  SceneFile scene;
  scene.path = "scene.toml";
  scene.models.push_back({"m.gltf", {}, {}});
  scene.settings = file;
  return planRender(scene, over);
}

Settings withQuality(const std::string& name) {
  Settings settings;
  settings.set("render.quality", name);
  return settings;
}

TEST(Quality, PresetsDenoiseAndGrow) {
  const RenderSettings draft = planned({}, withQuality("draft")).settings,
                       good = planned({}, withQuality("good")).settings,
                       best = planned({}, withQuality("final")).settings;
  EXPECT_TRUE(draft.denoise && good.denoise && best.denoise);
  EXPECT_LT(draft.samples, good.samples);
  EXPECT_LT(good.samples, best.samples);
  ASSERT_TRUE(good.noiseLimit && best.noiseLimit && !draft.noiseLimit);
  EXPECT_GT(*good.noiseLimit, *best.noiseLimit);
  EXPECT_LE(draft.maxDepth, good.maxDepth);
  EXPECT_LT(good.maxDepth, best.maxDepth);
  EXPECT_FALSE(planned({}, {}).settings.denoise);
  EXPECT_EQ(planned({}, {}).quality, "");
}

TEST(Quality, OfTheCommandLineReplacesTheFilesLimitsOnly) {
  Settings file;
  file.set("render.samples", uint64_t(9000));
  file.set("render.max_depth", uint64_t(31));
  const RenderDescription d = planned(file, withQuality("draft"));
  EXPECT_EQ(d.settings.samples, planned({}, withQuality("draft")).settings.samples);
  EXPECT_EQ(d.settings.maxDepth, 31);
  EXPECT_EQ(d.quality.find("max_depth"), std::string::npos) << d.quality;
}

TEST(Quality, GivenSettingsWin) {
  Settings over = withQuality("final");
  over.set("render.time", 3.0);
  over.set("render.denoise", false);
  const RenderDescription d = planned({}, over);
  EXPECT_EQ(d.settings.timeLimit, 3);
  EXPECT_FALSE(d.settings.noiseLimit) << "the limits are one decision";
  EXPECT_EQ(d.settings.samples, kMaxSamples);
  EXPECT_FALSE(d.settings.denoise);
  Settings file = withQuality("good"), samples;
  file.set("render.samples", uint64_t(7));
  EXPECT_EQ(planned(file, {}).settings.samples, 7u);
  samples.set("render.samples", uint64_t(5));
  EXPECT_EQ(planned(withQuality("good"), samples).settings.samples, 5u);
}

// What a quality brings may be idle; what was given beside it may not.
TEST(Quality, PartsWithoutEffectAreNotNamed) {
  SceneFile scene;
  scene.models.push_back({"m.gltf", {}, {}});
  Settings over;
  over.set("render.quality", std::string("draft"), "--quality");
  over.set("render.integrator", std::string("direct"), "--integrator");
  const SceneContents all{.hasProbe = true, .hasBodies = true};
  EXPECT_EQ(idleSettings(planRender(scene, over), all), std::vector<std::string>());
  over.set("render.max_depth", uint64_t(5), "--max-depth");
  EXPECT_EQ(idleSettings(planRender(scene, over), all),
            std::vector<std::string>{"--max-depth has no effect without the integrator path"});
}

// The header has the settings themselves.
TEST(Quality, HeaderSaysWhatItStoodFor) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "m.gltf");
  std::ofstream(folder / "s.toml") << "model = \"m.gltf\"\n[[light]]\ntype = \"point\"\n"
                                      "position = [0, 0, 3]\nintensity = 5\n";
  const auto headerOf = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"render", folder / "s.toml", "--size",    "16x12",
                                   "-o",     folder / "a.exr",  "--quality", "draft"};
    words.insert(words.end(), more.begin(), more.end());
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.error.find("warning"), std::string::npos) << result.error;
    return readExrMetadata(folder / "a.exr");
  };
  const RenderSettings draft = planned({}, withQuality("draft")).settings;
  const Metadata plain = headerOf({});
  EXPECT_EQ(std::get<std::string>(plain.at("quality"))
                .find(fmt::format("draft: samples {}, denoise", draft.samples)),
            0u);
  EXPECT_NEAR(metadataNumber(plain, "samples").value_or(0), draft.samples, 0.2 * draft.samples);
  EXPECT_EQ(metadataNumber(plain, "max-depth"), draft.maxDepth);
  EXPECT_TRUE(plain.contains("denoise"));
  const Metadata other = headerOf({"--samples", "4", "--denoise=false"});
  EXPECT_EQ(std::get<std::string>(other.at("quality")),
            fmt::format("draft: max_depth {}", draft.maxDepth));
  EXPECT_EQ(metadataNumber(other, "samples"), 4);
  EXPECT_FALSE(other.contains("denoise"));
}

}  // namespace
}  // namespace chromeball::quality_test
