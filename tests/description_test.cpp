// SPDX-License-Identifier: Apache-2.0
// A description rendered with the library, without the command.
#include "base/json.h"
#include "front/plan_render.h"
#include "session/render_loaded.h"

#include <gtest/gtest.h>

#include <climits>
#include <fstream>
#include <functional>
#include <set>

#include "base/error.h"
#include "description/describe.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/builder/scene_builder.h"
#include "session/image_header.h"
#include "small_model.h"

namespace chromeball::description_test {
namespace {

TEST(Description, RendersASceneFileToAnImageAndPrintsNothing) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  writeImage(folder / "probe.exr", constantProbe({8, 4}, Rgb(0.5f, 1, 2)));
  std::ofstream(folder / "scene.toml") << "model = 'model.gltf'\n[probe]\nfile = 'probe.exr'\n"
                                          "[render]\nsize = [12, 8]\nsamples = 2\n"
                                          "[output]\naovs = ['depth']\n";
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  RenderDescription description = planRender(openScene(folder / "scene.toml"));
  const LoadedScene loaded = loadScene(description);
  const FinishedRender result = renderLoaded(loaded);
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

using Change = std::function<void(RenderDescription&)>;

// Whether the change of a description in memory is in the header of an image and in the identity of
// its checkpoints.
void expectFound(const std::string& scene, const char* name, const Change& change) {
  const auto describe = [&](const Change& prepare) {
    RenderDescription description = planRender(openScene(scene));
    prepare(description);
    const LoadedScene loaded = loadScene(description);
    return std::pair(describeLoaded(loaded), renderIdentity(loaded));
  };
  const auto [header, identity] = describe([](RenderDescription&) {});
  const auto [changedHeader, changedIdentity] = describe(change);
  EXPECT_NE(toMetadata(header), toMetadata(changedHeader)) << name;
  EXPECT_NE(identity, changedIdentity) << name;
}

TEST(Description, WhatAProgramChangesIsInHeaderAndIdentity) {
  const TemporaryFolder folder;
  writeRichScene(folder);
  const std::pair<const char*, Change> plain[] = {
      {"size",
       [](RenderDescription& j) {
         j.size = ImageSize{6, 4};
       }},
      {"crop",
       [](RenderDescription& j) {
         j.settings.crop = Crop{1, 2, 3, 4};
       }},
      {"shard", [](RenderDescription& j) { j.settings = shardOf(j.settings, 1, 4); }},
      {"adaptive", [](RenderDescription& j) { j.settings.adaptive = false; }},
      {"guide", [](RenderDescription& j) { j.settings.guiding = Guiding::On; }},
      {"max depth", [](RenderDescription& j) { j.settings.maxDepth = 3; }},
      {"a depth that no setting may have",
       [](RenderDescription& j) { j.settings.maxDepth = INT_MAX - 1; }},
      {"transmission", [](RenderDescription& j) { j.settings.maxTransmissionDepth = 3; }},
      {"diffuse", [](RenderDescription& j) { j.settings.maxDiffuseDepth = 3; }},
      {"specular", [](RenderDescription& j) { j.settings.maxSpecularDepth = 3; }},
      {"integrator", [](RenderDescription& j) { j.settings.integrator = IntegratorKind::Direct; }},
      {"ao",
       [](RenderDescription& j) {
         j.settings.integrator = IntegratorKind::EnvironmentMap;
         j.settings.occlusion.ambient = true;
       }},
      {"reflections",
       [](RenderDescription& j) {
         j.settings.integrator = IntegratorKind::EnvironmentMap;
         j.settings.occlusion.reflection = true;
       }},
      {"distance",
       [](RenderDescription& j) {
         j.settings.integrator = IntegratorKind::AmbientOcclusion;
         j.settings.occlusion.distance = 2;
       }},
      {"bent",
       [](RenderDescription& j) {
         j.settings.aovs = {Aov::BentNormal};
         j.settings.occlusion.uniformBent = true;
       }},
      {"cache", [](RenderDescription& j) { j.settings.cacheError = 0.2f; }},
      {"mis", [](RenderDescription& j) { j.settings.mis = Mis::Power; }},
      {"seed", [](RenderDescription& j) { j.settings.seed = 5; }},
      {"transparent", [](RenderDescription& j) { j.settings.hideProbe = true; }},
      {"clamp", [](RenderDescription& j) { j.settings.clamp = 7; }},
      {"aovs", [](RenderDescription& j) { j.settings.aovs = {Aov::Depth}; }},
      {"groups", [](RenderDescription& j) { j.settings.lightGroups = true; }},
      {"mattes", [](RenderDescription& j) { j.settings.shadowMattes = true; }},
      {"regularize", [](RenderDescription& j) { j.settings.regularize = true; }},
      {"denoise", [](RenderDescription& j) { j.settings.denoise = true; }},
      {"single sided", [](RenderDescription& j) { j.singleSided = SingleSided::Off; }},
      {"glass", [](RenderDescription& j) { j.straightGlassShadows = true; }},
      {"shutter",
       [](RenderDescription& j) {
         j.camera.shutter = Shutter{0.25, 24, 4, 0};
       }},
      {"strategy", [](RenderDescription& j) { j.lighting.strategy = "bsdf"; }},
      {"scale", [](RenderDescription& j) { j.probe.scale = glm::dvec3(2); }},
      {"camera", [](RenderDescription& j) { j.camera.placed->position.x = 0.5f; }},
      {"view", [](RenderDescription& j) { j.camera.view.emplace(); }},
      {"node", [](RenderDescription& j) { j.camera.node = "a"; }},
      {"fov", [](RenderDescription& j) { j.camera.fov = 30; }},
      {"zoom", [](RenderDescription& j) { j.camera.zoom = 2; }},
      {"turntable", [](RenderDescription& j) { j.stand.turntable = 20; }},
      {"drop", [](RenderDescription& j) { j.stand.drops = true; }},
      {"ground", [](RenderDescription& j) { j.stand.hasGround = true; }},
      {"lens",
       [](RenderDescription& j) {
         j.camera.lens = Lens{0.1f, 3};
       }},
      {"lamp", [](RenderDescription& j) { j.lamps[0].punctual->intensity = Rgb(2); }},
      {"place of a lamp", [](RenderDescription& j) { j.lamps[0].position.y += 1; }},
      {"no lamps", [](RenderDescription& j) { j.lamps.clear(); }},
      {"placement", [](RenderDescription& j) { j.models[0].placement.translation.x = 1; }},
      {"one more model", [](RenderDescription& j) { j.models.push_back(j.models[0]); }},
      {"surroundings",
       [](RenderDescription& j) {
         j.surroundings =
             SurroundingsEntry{.shape = {.shape = Surroundings::Shape::Sphere, .radius = 50}};
       }},
  };
  for (const auto& [name, change] : plain) expectFound(folder / "plain.toml", name, change);
  const std::pair<const char*, Change> composite[] = {
      {"plate", [](RenderDescription& j) { j.composite->plate.texels[5] = 0.25f; }},
      {"mode", [](RenderDescription& j) { j.composite->mode = CompositeMode::Ratio; }},
      {"iterations", [](RenderDescription& j) { j.composite->iterations = 5; }},
      {"passes", [](RenderDescription& j) { j.composite->passes = Passes::Two; }},
      {"layers", [](RenderDescription& j) { j.composite->layers = {"l_obj"}; }},
      {"ground", [](RenderDescription& j) { j.composite->entry.groundReflectance = Rgb(0.3f); }},
  };
  for (const auto& [name, change] : composite) expectFound(folder / "composite.toml", name, change);
}

// A setting in none of the lists of differences.cpp loads the scene again, which is right only for
// what the scene is made of.
TEST(Description, OnlyWhatTheSceneIsMadeOfLoadsItAgain) {
  const TemporaryFolder folder;
  writeRichScene(folder);
  std::set<std::string> loadAgain;
  for (const char* scene : {"plain.toml", "composite.toml"}) {
    RenderDescription d = planRender(openScene(folder / scene));
    d.settings.noiseLimit = 0.1, d.settings.timeLimit = 1;
    d.settings.cacheError = 0.2f, d.settings.clamp = 7, d.settings.regularize = true;
    d.camera.shutter = Shutter{0.25, 24, 4, 0};
    d.camera.lens = Lens{0.1f, 3};
    d.lighting.sunAngle = 1;
    d.scene = std::make_shared<const Scene>();
    d.probe.map = std::make_shared<const Image>(2, 1, 3);
    const nlohmann::ordered_json all = describe(d);
    for (const auto& [name, ignored] : all.items())
      if (!Differences::keepsScene(name)) loadAgain.insert(name);
  }
  const std::set<std::string> ofTheScene = {
      "composite",       "fps",          "glass-shadows", "light-from",    "light-units",
      "lights",          "local-scene",  "models",        "regularize",    "scene",
      "scene-in-memory", "scene-lights", "shutter",       "shutter-steps", "single-sided"};
  EXPECT_EQ(loadAgain, ofTheScene);
}

// This holds also where the scene is far from the world's origin. Only the image's size may come
// from the models.
TEST(Description, LoadingChangesNothingOfTheDescription) {
  const TemporaryFolder folder;
  writeRichScene(folder);
  std::ofstream(folder / "far.toml")
      << "[[model]]\nfile = 'model.gltf'\ntranslation = [1e6, 0, 0]\n"
         "[probe]\nfile = 'probe.exr'\n[camera]\nposition = [1e6, 1, 4]\nlook_at = [1e6, 0, 0]\n"
         "[surroundings]\nshape = 'box'\nmin = [999990, -9, -9]\nmax = [1000010, 9, 9]\ncapture = "
         "[1e6, 1, 1]\n";
  for (const char* scene : {"plain.toml", "composite.toml", "far.toml"}) {
    RenderDescription description = planRender(openScene(folder / scene));
    nlohmann::ordered_json before = describe(description);
    nlohmann::ordered_json after = describe(loadScene(description).description);
    before.erase("size"), after.erase("size");
    EXPECT_EQ(jsonText(before), jsonText(after)) << scene;
  }
}

// A triangle and a probe from arrays.
RenderDescription fromMemory(float height, float radiance) {
  Scene scene;
  SceneBuilder builder(scene);
  Material white;
  white.metallic = 0;
  white.specular = 0;
  white.doubleSided = true;
  const int material = builder.addMaterial(white);
  Mesh soup;
  soup.positions = {{-1, height, 1}, {1, height, 1}, {0, height, -1}};
  builder.addInstance(builder.addMesh(soup, material), material, builder.addNode("soup"));
  RenderDescription description;
  description.scene = std::make_shared<const Scene>(std::move(scene));
  description.probe.map = std::make_shared<const Image>(constantProbe({8, 4}, Rgb(radiance)));
  description.lighting.strategy = "auto";
  description.size = ImageSize{16, 12};
  description.settings.samples = 64;
  return description;
}

// A white surface under a white probe vanishes; the bits are the same as for the same model in a
// file.
TEST(Description, RendersArrays) {
  const RenderDescription description = fromMemory(0, 0.5f);
  const LoadedScene loaded = loadScene(description);
  const FinishedRender result = renderLoaded(loaded);
  ASSERT_EQ(result.color().width, 16);
  double sum = 0;
  for (const float texel : result.color().texels) sum += double(texel);
  EXPECT_NEAR(sum / double(result.color().texels.size()), 0.5, 0.005);
  EXPECT_TRUE(loaded.messages.empty());

  GltfWriter w;
  w.add("materials", {{"doubleSided", true},
                      {"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                      {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  const int mesh = w.mesh(
      {{"attributes", {{"POSITION", w.vec3s({-1, 0, 1, 1, 0, 1, 0, 0, -1})}}}, {"material", 0}});
  w.add("nodes", {{"mesh", mesh}});
  RenderDescription file = description;
  file.scene.reset();
  file.models.push_back({w.save(), {}, {}});
  EXPECT_EQ(renderLoaded(loadScene(file)).color().texels, result.color().texels);
}

TEST(Description, ArraysAreInHeaderAndIdentity) {
  const auto identity = [](const RenderDescription& d) { return renderIdentity(loadScene(d)); };
  const RenderDescription first = fromMemory(0, 0.5f);
  EXPECT_EQ(identity(first), identity(fromMemory(0, 0.5f)));
  EXPECT_NE(identity(first), identity(fromMemory(0.01f, 0.5f)));
  EXPECT_NE(identity(first), identity(fromMemory(0, 0.6f)));
  EXPECT_NE(describe(first), describe(fromMemory(0.01f, 0.5f)));
  EXPECT_NE(describe(first), describe(fromMemory(0, 0.6f)));
}

TEST(Description, AProbeFromAnArrayIsChecked) {
  RenderDescription description = fromMemory(0, 1);
  for (const float bad : {NAN, INFINITY, -1.0f}) {
    Image map = constantProbe({8, 4}, Rgb(1));
    *map.at(3, 2) = bad;
    description.probe.map = std::make_shared<const Image>(map);
    try {
      loadScene(description);
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "the probe's map: texel 3, 2 must be finite, and not negative");
    }
  }
}

TEST(Description, AnUnlitLocalSceneIsWarnedOf) {
  for (const bool unlit : {false, true}) {
    Scene scene;
    SceneBuilder builder(scene);
    Material floor;
    floor.unlit = unlit;
    const int material = builder.addMaterial(floor), matte = builder.addMaterial({});
    Mesh triangle;
    triangle.positions = {{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}};
    builder.addInstance(builder.addMesh(triangle, material), material, builder.addNode("floor"));
    for (vec3& p : triangle.positions) p.y = 0.5f;
    builder.addInstance(builder.addMesh(triangle, matte), matte, builder.addNode("object"));
    RenderDescription description = fromMemory(0, 1);
    description.scene = std::make_shared<const Scene>(std::move(scene));
    CompositeDescription& composite = description.composite.emplace();
    composite.mode = CompositeMode::ShadowCatcher;
    composite.entry.localScene = {"floor"};
    const LoadedScene loaded = loadScene(description);
    EXPECT_EQ(std::ranges::any_of(
                  loaded.messages,
                  [](const Message& m) { return m.text.find("is unlit") != std::string::npos; }),
              unlit);
  }
}

TEST(Description, ErrorsSuggestASetting) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "model.gltf");
  try {
    RenderDescription description = planRender(openScene(folder / "model.gltf"));
    loadScene(description);
    ADD_FAILURE() << "nothing lights the scene";
  } catch (const InputError& error) {
    ASSERT_TRUE(error.remedy);
    EXPECT_EQ(error.remedy->setting, "probe.file");
    EXPECT_EQ(std::string(error.what()).find("--"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chromeball::description_test
