// SPDX-License-Identifier: Apache-2.0
// A job rendered with the library, without the command.
#include "job/job.h"
#include "base/json.h"
#include "base/json_text.h"

#include <gtest/gtest.h>

#include <climits>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "image/io/write_image.h"
#include "job/job_changes.h"
#include "job/job_description.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::job_test {
namespace {

TEST(Job, RendersASceneFileToAnImageAndPrintsNothing) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  writeImage(folder / "probe.exr", constantProbe({8, 4}, Rgb(0.5f, 1, 2)));
  std::ofstream(folder / "scene.toml") << "model = 'model.gltf'\n[probe]\nfile = 'probe.exr'\n"
                                          "[render]\nsize = [12, 8]\nsamples = 2\n"
                                          "[output]\naovs = ['depth']\n";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  RenderJob job = planJob(openScene(folder / "scene.toml"));
  const LoadedScene loaded = loadScene(job);
  const JobResult result = renderJob(job, loaded);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");

  EXPECT_EQ(result.color().width, 12);
  EXPECT_EQ(result.color().height, 8);
  EXPECT_EQ(result.color().rgb(0, 0), Rgb(0.5f, 1, 2));
  EXPECT_EQ(result.render.samples, 2u);
  ASSERT_EQ(result.image.layers.size(), 2u);
  EXPECT_EQ(result.image.layers[1].name, "depth");
  ASSERT_EQ(loaded.messages.size(), 1u) << "the mapping was detected";
  EXPECT_EQ(loaded.messages[0].kind, Message::Kind::Note);

  ASSERT_EQ(runCommand({"render", folder / "scene.toml", "-o", folder / "a.pfm"}).status, 0);
  EXPECT_EQ(readImage(folder / "a.pfm").texels, result.color().texels);
}

// A scene file with all kinds of parts; its composite has a plate of 12 x 8 pixels.
void writeRichScene(const TemporaryFolder& folder) {
  writeSmallModel(folder / "model.gltf");
  writeImage(folder / "probe.exr", constantProbe({8, 4}, Rgb(0.5f, 1, 2)));
  writeImage(folder / "plate.exr", constantProbe({12, 8}, Rgb(0.5f)));
  const std::string common =
      "[[model]]\nfile = 'model.gltf'\n[probe]\nfile = 'probe.exr'\n"
      "[camera]\nposition = [0, 1, 4]\nlook_at = [0, 0, 0]\n[render]\nsize = [12, 8]\n"
      "[[light]]\ntype = 'point'\nposition = [0, 3, 0]\nintensity = 1\n";
  std::ofstream(folder / "plain.toml") << common;
  std::ofstream(folder / "composite.toml")
      << common << "[composite]\nplate = 'plate.exr'\nground = true\n";
}

using Change = std::function<void(RenderJob&)>;

// Whether the change of a job in memory is in the header of an image and in the identity of its
// checkpoints.
void expectFound(const std::string& scene, const char* name, const Change& change) {
  const auto describe = [&](const Change& prepare) {
    RenderJob job = planJob(openScene(scene));
    prepare(job);
    const LoadedScene loaded = loadScene(job);
    return std::pair(describeJob(job, loaded), renderIdentity(job, loaded));
  };
  const auto [header, identity] = describe([](RenderJob&) {});
  const auto [changedHeader, changedIdentity] = describe(change);
  EXPECT_NE(toMetadata(header), toMetadata(changedHeader)) << name;
  EXPECT_NE(identity, changedIdentity) << name;
}

TEST(Job, WhatAProgramChangesIsInHeaderAndIdentity) {
  const TemporaryFolder folder;
  writeRichScene(folder);
  const std::pair<const char*, Change> plain[] = {
      {"size",
       [](RenderJob& j) {
         j.size = ImageSize{6, 4};
       }},
      {"crop",
       [](RenderJob& j) {
         j.settings.crop = Crop{1, 2, 3, 4};
       }},
      {"shard", [](RenderJob& j) { j.settings = shardOf(j.settings, 1, 4); }},
      {"adaptive", [](RenderJob& j) { j.settings.adaptive = false; }},
      {"guide", [](RenderJob& j) { j.settings.guiding = Guiding::On; }},
      {"max depth", [](RenderJob& j) { j.settings.maxDepth = 3; }},
      {"a depth that no setting may have", [](RenderJob& j) { j.settings.maxDepth = INT_MAX - 1; }},
      {"transmission", [](RenderJob& j) { j.settings.maxTransmissionDepth = 3; }},
      {"diffuse", [](RenderJob& j) { j.settings.maxDiffuseDepth = 3; }},
      {"specular", [](RenderJob& j) { j.settings.maxSpecularDepth = 3; }},
      {"integrator", [](RenderJob& j) { j.settings.integrator = IntegratorKind::Direct; }},
      {"ao", [](RenderJob& j) { j.settings.occlusion.ambient = true; }},
      {"reflections", [](RenderJob& j) { j.settings.occlusion.reflection = true; }},
      {"distance", [](RenderJob& j) { j.settings.occlusion.distance = 2; }},
      {"bent", [](RenderJob& j) { j.settings.occlusion.uniformBent = true; }},
      {"cache", [](RenderJob& j) { j.settings.cacheError = 0.2f; }},
      {"mis", [](RenderJob& j) { j.settings.mis = Mis::Power; }},
      {"seed", [](RenderJob& j) { j.settings.seed = 5; }},
      {"transparent", [](RenderJob& j) { j.settings.hideProbe = true; }},
      {"clamp", [](RenderJob& j) { j.settings.clamp = 7; }},
      {"aovs", [](RenderJob& j) { j.settings.aovs = {Aov::Depth}; }},
      {"groups", [](RenderJob& j) { j.settings.lightGroups = true; }},
      {"mattes", [](RenderJob& j) { j.settings.shadowMattes = true; }},
      {"regularize", [](RenderJob& j) { j.settings.regularize = true; }},
      {"denoise", [](RenderJob& j) { j.settings.denoise = true; }},
      {"single sided", [](RenderJob& j) { j.singleSided = SingleSided::Off; }},
      {"glass", [](RenderJob& j) { j.straightGlassShadows = true; }},
      {"shutter",
       [](RenderJob& j) {
         j.shutter = Shutter{0.01, 4, 0};
       }},
      {"strategy", [](RenderJob& j) { j.strategy.name = "bsdf"; }},
      {"scale", [](RenderJob& j) { j.file.settings.set("probe.scale", std::vector{2.0}); }},
      {"camera", [](RenderJob& j) { j.file.camera->position.x = 0.5f; }},
      {"lens",
       [](RenderJob& j) {
         j.file.lens = Lens{0.1f, 3, ""};
       }},
      {"lamp", [](RenderJob& j) { j.file.lamps[0].punctual->intensity = Rgb(2); }},
      {"place of a lamp", [](RenderJob& j) { j.file.lamps[0].position.y += 1; }},
      {"no lamps", [](RenderJob& j) { j.file.lamps.clear(); }},
      {"placement", [](RenderJob& j) { j.file.models[0].placement.translation.x = 1; }},
      {"one more model", [](RenderJob& j) { j.file.models.push_back(j.file.models[0]); }},
      {"surroundings",
       [](RenderJob& j) {
         j.file.surroundings =
             SurroundingsEntry{.shape = {.shape = Surroundings::Shape::Sphere, .radius = 50}};
       }},
  };
  for (const auto& [name, change] : plain) expectFound(folder / "plain.toml", name, change);
  const std::pair<const char*, Change> composite[] = {
      {"plate", [](RenderJob& j) { j.composite->plate.texels[5] = 0.25f; }},
      {"mode", [](RenderJob& j) { j.composite->mode = CompositeMode::Ratio; }},
      {"iterations", [](RenderJob& j) { j.composite->iterations = 5; }},
      {"passes", [](RenderJob& j) { j.composite->passes = Passes::Two; }},
      {"layers", [](RenderJob& j) { j.composite->layers = {"l_obj"}; }},
      {"ground", [](RenderJob& j) { j.file.composite->groundReflectance = Rgb(0.3f); }},
  };
  for (const auto& [name, change] : composite) expectFound(folder / "composite.toml", name, change);
}

// Loading a job changes nothing of it, also where the scene is far from the world's origin.
TEST(Job, WhatIsAsPlannedIsNotDescribedTwice) {
  const TemporaryFolder folder;
  writeRichScene(folder);
  std::ofstream(folder / "far.toml")
      << "[[model]]\nfile = 'model.gltf'\ntranslation = [1e6, 0, 0]\n"
         "[probe]\nfile = 'probe.exr'\n[camera]\nposition = [1e6, 1, 4]\nlook_at = [1e6, 0, 0]\n"
         "[surroundings]\nshape = 'box'\nmin = [999990, -9, -9]\nmax = [1000010, 9, 9]\ncapture = "
         "[1e6, 1, 1]\n";
  for (const char* scene : {"plain.toml", "composite.toml", "far.toml"}) {
    Settings given;
    given.set("render.noise", 7.3);
    given.set("camera.shutter", 0.4);
    given.set("clamp", 0.15);
    if (std::string(scene) != "plain.toml") given = {};
    RenderJob job = planJob(openScene(folder / scene), given);
    const LoadedScene loaded = loadScene(job);
    nlohmann::ordered_json changes = nlohmann::ordered_json::object();
    describeChanges(job, changes);
    EXPECT_EQ(jsonText(changes), "{}") << scene;
  }
}

TEST(Job, ErrorsSuggestASetting) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  try {
    RenderJob job = planJob(openScene(folder / "model.gltf"));
    loadScene(job);
    ADD_FAILURE() << "nothing lights the scene";
  } catch (const InputError& error) {
    ASSERT_TRUE(error.remedy);
    EXPECT_EQ(error.remedy->setting, "probe.file");
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chromeball::job_test
