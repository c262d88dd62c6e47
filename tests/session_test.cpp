// SPDX-License-Identifier: Apache-2.0
// A render in the background: snapshots, changes, two at once, and its end.
#include "session/session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>

#include "base/error.h"
#include "image/io/write_image.h"
#include "lighting/strategy.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/builder/scene_builder.h"
#include "scene/gltf/model_cache.h"
#include "session/image_header.h"
#include "session/render_loaded.h"
#include "test_scene.h"

namespace chromeball::session_test {
namespace {

using namespace std::chrono_literals;

// A ball on a floor; `lift` moves the ball by its transform, while the meshes stay.
struct Stage {
  std::shared_ptr<const Mesh> ball, floor;

  Stage() {
    Scene scene;
    addSphere(scene, addMaterial(scene, lambert(Rgb(0.5f))), {0, 0.5f, 0}, 0.5f, 16);
    addQuad(scene, 0, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    ball = scene.meshes.shared(0), floor = scene.meshes.shared(1);
  }

  std::shared_ptr<const Scene> scene(float lift = 0, Rgb color = Rgb(0.7f, 0.5f, 0.3f)) const {
    auto scene = std::make_shared<Scene>();
    SceneBuilder builder(*scene);
    const int material = builder.addMaterial(lambert(color));
    const int node = builder.addNode("ball");
    Transform up;
    up.translation.y = lift;
    builder.addInstance(builder.addMesh(ball), material, node, up);
    builder.addInstance(builder.addMesh(floor), material, node, Transform());
    return scene;
  }
};

RenderDescription stageDescription(const Stage& stage, uint32_t samples = 16) {
  RenderDescription d;
  d.scene = stage.scene();
  d.probe.map = std::make_shared<const Image>(gradientProbe({64, 32}, Rgb(0.5f), {0.1, 0.3, 0.2}));
  d.lighting.strategy = "importance";
  d.camera.placed =
      CameraEntry{.position = {0, 1, 4}, .target = {0, 0.5, 0}, .up = {0, 1, 0}, .lens = {}};
  d.size = ImageSize{48, 32};
  d.settings.samples = samples;
  return d;
}

Image sunnyMap() {
  Image map = constantProbe({128, 64}, Rgb(0.2f));
  for (int x = 30; x < 33; ++x) map.setRgb(x, 20, Rgb(500));
  return map;
}

std::vector<float> freshRender(const RenderDescription& description) {
  return renderLoaded(loadScene(description)).color().texels;
}

TEST(Session, GivesTheBitsOfARenderInTheForeground) {
  const RenderDescription description = stageDescription(Stage());
  Session session(description);
  session.start();
  EXPECT_EQ(session.wait().color().texels, freshRender(description));
  EXPECT_FALSE(session.isRunning());
  const auto snapshot = session.snapshot();
  ASSERT_TRUE(snapshot);
  EXPECT_EQ(snapshot->color().texels, session.wait().color().texels);
  EXPECT_NEAR(snapshot->samples, 16, 1);  // an adaptive render
}

TEST(Session, RefusesArraysThatReachTooFar) {
  Stage stage;
  Scene far;
  addQuad(far, addMaterial(far, lambert(Rgb(0.5f))), {-3e9f, 0, 3e9f}, {6e9f, 0, 0}, {0, 0, -6e9f});
  stage.floor = far.meshes.shared(0);
  try {
    Session session(stageDescription(stage));
    session.start();
    session.wait();
    ADD_FAILURE() << "3e9 m";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("the limit is 1e+09"), std::string::npos)
        << error.what();
  }
}

// Each snapshot has more samples than the one before, and none is invalid; the render's bits stay.
TEST(Session, SnapshotsGrow) {
  const RenderDescription description = stageDescription(Stage(), 1024);
  Session session(description);
  session.start();
  double last = 0;
  int taken = 0;
  while (session.isRunning()) {
    const auto snapshot = session.snapshot();
    if (!snapshot) continue;
    ++taken;
    EXPECT_GE(snapshot->samples, last);
    last = snapshot->samples;
    const Image& color = snapshot->color();
    EXPECT_EQ(color.width, 48);
    for (const float texel : color.texels) EXPECT_TRUE(std::isfinite(texel) && texel >= 0);
  }
  EXPECT_GT(taken, 2);
  EXPECT_EQ(session.wait().color().texels, freshRender(description));
}

// After any change the bits are the same as in a new session, and only what the change touches is
// done again.
TEST(Session, UpdateRedoesWhatDiffers) {
  const Stage stage;
  RenderDescription d = stageDescription(stage);
  Session session(d);
  session.start();
  session.wait();
  EXPECT_TRUE(session.work().loadedScene);
  const auto change = [&](const char* what, const std::function<void()>& edit) {
    edit();
    session.update(d);
    session.start();
    EXPECT_EQ(session.wait().color().texels, freshRender(d)) << what;
    return session.work();
  };
  const auto isOnly = [](const Session::Work& w, bool scene, bool probe, bool lighting) {
    return w.loadedScene == scene && w.loadedProbe == probe && w.preparedLighting == lighting;
  };
  EXPECT_TRUE(isOnly(change("camera", [&] { d.camera.placed->position.x = 1; }), 0, 0, 0));
  EXPECT_TRUE(isOnly(change("size", [&] { d.size = ImageSize{32, 32}; }), 0, 0, 0));
  EXPECT_TRUE(isOnly(change("seed", [&] { d.settings.seed = 3; }), 0, 0, 0));
  EXPECT_TRUE(isOnly(change("depth", [&] { d.settings.maxDepth = 2; }), 0, 0, 0));
  EXPECT_TRUE(isOnly(change("rotation", [&] { d.probe.rotation = Rotation(40); }), 0, 0, 1));
  EXPECT_TRUE(isOnly(change("tilt",
                            [&] {
                              d.probe.rotation = Rotation::ofAngles({10, 20, 30});
                            }),
                     0, 0, 1));
  EXPECT_TRUE(isOnly(change("scale", [&] { d.probe.scale = glm::dvec3(0.1, 2, 3); }), 0, 1, 1));
  EXPECT_TRUE(isOnly(change("strategy", [&] { d.lighting.strategy = "median-cut:16"; }), 0, 0, 1));
  EXPECT_TRUE(isOnly(change("mis",
                            [&] {
                              d.lighting.strategy = "importance";
                              d.settings.mis = Mis::Power;
                            }),
                     0, 0, 1));
  EXPECT_TRUE(
      isOnly(change("map",
                    [&] {
                      d.probe.map = std::make_shared<const Image>(constantProbe({16, 8}, Rgb(2)));
                    }),
             0, 1, 1));
  EXPECT_TRUE(isOnly(change("suns",
                            [&] {
                              d.probe.map = std::make_shared<const Image>(sunnyMap());
                              d.lighting.strategy = "suns";
                            }),
                     0, 1, 1));
  EXPECT_TRUE(isOnly(change("angle of suns", [&] { d.lighting.sunAngle = 20; }), 0, 0, 1));
  EXPECT_TRUE(isOnly(change("own strategy",
                            [&] {
                              d.lighting.strategy = "uniform";
                              d.lighting.make = [](const Probe& probe, const glm::dvec3&) {
                                return makeStrategy("importance", probe, Mis::Power, "test");
                              };
                            }),
                     0, 0, 1));
  EXPECT_TRUE(isOnly(change("a built-in one of its name", [&] { d.lighting.make = {}; }), 0, 0, 1));
  EXPECT_TRUE(isOnly(change("groups", [&] { d.settings.lightGroups = true; }), 0, 0, 1));
  EXPECT_TRUE(change("moved", [&] { d.scene = stage.scene(0.5f); }).loadedScene);
  EXPECT_TRUE(change("material", [&] { d.scene = stage.scene(0.5f, Rgb(0.1f)); }).loadedScene);
}

// Changes from a map in memory to a file and back: the files that were read are named in
// identities.
TEST(Session, AProbesFileIsAmongTheFilesThatWereRead) {
  const TemporaryFolder folder;
  writeImage(folder / "sky.exr", sunnyMap());
  RenderDescription map = stageDescription(Stage()), file = map;
  file.probe.map.reset();
  file.probe.file = folder / "sky.exr";
  ModelCache cache;
  LoadedScene loaded = loadScene(map);
  EXPECT_TRUE(loaded.files.empty());
  loadFrame(file, loaded, cache);
  EXPECT_EQ(loaded.files, std::vector<std::string>{folder / "sky.exr"});
  EXPECT_EQ(renderIdentity(loaded), renderIdentity(loadScene(file)));
  loadFrame(map, loaded, cache);
  EXPECT_TRUE(loaded.files.empty());
}

TEST(Session, AMovedNodeKeepsTheStructuresOfMeshes) {
  const Stage stage;
  RenderDescription d = stageDescription(stage);
  Session session(d);
  session.start();
  session.wait();
  const int builds = session.work().meshBuilds;
  d.scene = stage.scene(1);
  session.update(d);
  session.start();
  session.wait();
  EXPECT_EQ(session.work().meshBuilds, builds);
}

// What the command writes into the header of an .exr.
TEST(Session, TheImageHasItsMetadata) {
  RenderDescription d = stageDescription(Stage());
  d.settings.maxDepth = 3;
  Session session(d);
  EXPECT_THROW(session.wait(), std::logic_error);
  session.start();
  const auto metadata = [&] { return session.wait().image.metadata; };
  EXPECT_EQ(metadataNumber(metadata(), "max-depth"), 3);
  d.settings.maxDepth = 4;
  session.update(d);
  EXPECT_THROW(session.wait(), std::logic_error);
  session.start();
  EXPECT_EQ(metadataNumber(metadata(), "max-depth"), 4);
}

// Of a description that has not begun to render there is no image, also after another one's.
TEST(Session, HasNoSnapshotBeforeItBegins) {
  RenderDescription d = stageDescription(Stage());
  Session session(d);
  EXPECT_FALSE(session.snapshot());
  session.start();
  session.wait();
  EXPECT_TRUE(session.snapshot());
  session.update(d);
  EXPECT_FALSE(session.snapshot());
  session.start();
  session.wait();
  EXPECT_TRUE(session.snapshot());
}

TEST(Session, CancelsAndBeginsAnew) {
  RenderDescription d = stageDescription(Stage(), kMaxSamples);
  Session session(d);
  session.start();
  while (!session.snapshot()) std::this_thread::sleep_for(1ms);
  session.cancel();
  EXPECT_FALSE(session.isRunning());
  EXPECT_FALSE(session.wait().isComplete);
  d.settings.samples = 4;
  session.update(d);
  session.start();
  EXPECT_EQ(session.wait().color().texels, freshRender(d));
}

TEST(Session, TwoAtOnceDoNotDisturbEachOther) {
  const Stage stage;
  const RenderDescription first = stageDescription(stage, 64);
  RenderDescription second = first;
  second.probe.rotation = Rotation(90);
  Session a(first), b(second);
  a.start();
  b.start();
  EXPECT_EQ(a.wait().color().texels, freshRender(first));
  EXPECT_EQ(b.wait().color().texels, freshRender(second));
}

TEST(Session, ErrorsAreThrownByWait) {
  RenderDescription d = stageDescription(Stage());
  d.lighting.strategy = "none";
  Session session(d);
  session.start();
  EXPECT_THROW(session.wait(), InputError);
  d.lighting.strategy = "uniform";
  session.update(d);
  session.start();
  EXPECT_EQ(session.wait().color().texels, freshRender(d));
}

}  // namespace
}  // namespace chromeball::session_test
