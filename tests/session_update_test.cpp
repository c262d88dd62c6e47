// SPDX-License-Identifier: Apache-2.0
// After update() the picture has the bits of a fresh render, whatever was rendered before.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "base/error.h"
#include "base/file_stamps.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "session/render_loaded.h"
#include "session/session.h"
#include "temporary_folder.h"
#include "test_scene.h"

namespace chromeball::session_update_test {
namespace {

using namespace std::chrono_literals;

std::vector<float> freshRender(const RenderDescription& description) {
  return renderLoaded(loadScene(description)).color().texels;
}

// What update() to this description redoes. Expects the bits of a fresh render.
Session::Work show(Session& session, const RenderDescription& description, const std::string& what,
                   const std::vector<float>& expected) {
  session.update(description);
  session.start();
  EXPECT_EQ(session.wait().color().texels, expected) << what;
  return session.work();
}
Session::Work show(Session& session, const RenderDescription& description,
                   const std::string& what) {
  return show(session, description, what, freshRender(description));
}

// A table beside the origin; `isClosed`: in a room whose walls face inwards, so that it is black
// unless the view lets light in.
std::shared_ptr<const Scene> tableIn(bool isClosed) {
  auto scene = std::make_shared<Scene>();
  Material grey = lambert(Rgb(0.6f, 0.5f, 0.3f));
  grey.doubleSided = false;
  addMaterial(*scene, grey);
  const auto addSides = [&](vec3 middle, vec3 half, bool inwards) {
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f}) {
        vec3 out(0), a(0), b(0);
        out[axis] = side * half[axis];
        a[(axis + 1) % 3] = half[(axis + 1) % 3], b[(axis + 2) % 3] = half[(axis + 2) % 3];
        if ((side < 0) != inwards) std::swap(a, b);
        addQuad(*scene, 0, middle + out - a - b, 2.0f * a, 2.0f * b);
      }
  };
  addSides({3, 0.4f, 0}, {0.5f, 0.4f, 0.3f}, false);
  scene->nodeNames = {"table", "walls"};
  if (isClosed) addSides({3, 1.25f, 0}, {3, 1.25f, 4}, true);
  for (size_t i = 6; i < scene->instances.size(); ++i) scene->instances[i].node = 1;
  return scene;
}

RenderDescription automatic(bool isClosed) {
  RenderDescription d;
  d.scene = tableIn(isClosed);
  d.probe.map = std::make_shared<const Image>(gradientProbe({16, 8}, Rgb(0.5f), {0.1, 0.3, 0.2}));
  d.lighting.strategy = "importance";
  d.size = ImageSize{16, 12};
  d.settings.samples = 1;
  d.choosesSides = true;
  return d;
}

void place(RenderDescription& d) {
  d.camera.placed =
      CameraEntry{.position = {2, 1.4, 2.5}, .target = {3, 0.4, 0}, .up = {0, 1, 0}, .lens = {}};
}
void orbit(RenderDescription& d, double degrees) {
  d.camera.orbit = degrees;
  d.camera.turns = true;
}

struct View {
  const char* name;
  std::function<void(RenderDescription&)> choose;
};
const std::vector<View> kViews = {
    {"automatic", [](RenderDescription&) {}},
    {"upright image",
     [](RenderDescription& d) {
       d.size = ImageSize{12, 24};
     }},
    {"field of view", [](RenderDescription& d) { d.camera.fov = 30; }},
    {"zoom and crop",
     [](RenderDescription& d) {
       d.camera.zoom = 2, d.settings.crop = {3, 2, 8, 9};
     }},
    {"orbit", [](RenderDescription& d) { orbit(d, 40); }},
    {"from above",
     [](RenderDescription& d) {
       d.camera.view = ViewAngles{10, 60};
     }},
    {"node", [](RenderDescription& d) { d.camera.node = "table"; }},
    {"sides are given", [](RenderDescription& d) { d.choosesSides = false; }},
    {"placed", place},
    {"placed, field of view", [](RenderDescription& d) { place(d), d.camera.fov = 70; }},
    {"placed, orbit", [](RenderDescription& d) { place(d), orbit(d, 40); }},
    {"on a ground", [](RenderDescription& d) { d.stand.hasGround = true; }},
};

// Each view follows each other one.
void expectAnyOrder(bool isClosed) {
  const RenderDescription first = automatic(isClosed);  // all have its scene
  std::vector<RenderDescription> descriptions;
  std::vector<std::vector<float>> expected;
  for (const View& view : kViews) {
    RenderDescription d = first;
    view.choose(d);
    expected.push_back(freshRender(d));
    descriptions.push_back(std::move(d));
  }
  Session session(descriptions[0]);
  const auto move = [&](size_t from, size_t to) {
    show(session, descriptions[to], fmt::format("{} after {}", kViews[to].name, kViews[from].name),
         expected[to]);
  };
  for (size_t i = 0; i < kViews.size(); ++i) {
    for (size_t k = i + 1; k < kViews.size(); ++k) move(i, k), move(k, i);
    if (i + 1 < kViews.size()) move(i, i + 1);
  }
}

TEST(SessionUpdate, AnyViewAfterAnyOther) { expectAnyOrder(false); }
TEST(SlowSessionUpdate, AnyViewOfARoomAfterAnyOther) { expectAnyOrder(true); }

// A view that does not depend on what differs is kept.
TEST(SessionUpdate, OnlyAnotherViewLoadsTheScene) {
  RenderDescription d = automatic(false);
  Session session(d);
  const auto loads = [&](const char* what) { return show(session, d, what).loadedScene; };
  loads("first");
  d.camera.zoom = 1.5;
  EXPECT_FALSE(loads("zoom"));
  d.size = ImageSize{32, 24};
  EXPECT_FALSE(loads("the same aspect ratio"));
  d.size = ImageSize{32, 32};
  EXPECT_TRUE(loads("another aspect ratio"));
  orbit(d, 20);
  EXPECT_TRUE(loads("a camera that turns"));
  orbit(d, 50);
  EXPECT_FALSE(loads("and turns further"));
  place(d);
  loads("placed");
  d.camera.fov = 30, d.size = ImageSize{16, 32}, d.camera.view = ViewAngles{};
  EXPECT_FALSE(loads("of no effect on a placed camera's place"));
}

// A model translated by what float rounds off has moved.
TEST(SessionUpdate, AFarModelThatMovesALittle) {
  GltfWriter w;
  addTriangle(w);
  RenderDescription d = automatic(false);
  d.scene.reset();
  d.models = {{.file = w.save(), .placement = {}, .choice = {}}};
  d.models[0].placement.translation.x = 1e8f;
  d.camera.placed =
      CameraEntry{.position = {1e8, 0, 3}, .target = {1e8, 0, 0}, .up = {0, 1, 0}, .lens = {}};
  Session session(d);
  show(session, d, "first");
  d.models[0].translationRest.x = 0.5;
  EXPECT_TRUE(show(session, d, "moved by half a metre").loadedScene);
}

// Models of one name in two folders, and an animation that is chosen and not any more.
TEST(SessionUpdate, OtherFoldersAndAnimations) {
  GltfWriter still, moving;
  addTriangle(still);
  addTriangle(moving, {}, {{"scale", {2, 1, 1}}});
  const int times = moving.accessor(moving.view(std::vector<float>{0, 1}), kFloat, "SCALAR", 2);
  moving.add("animations",
             {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
              {"samplers", {{{"input", times}, {"output", moving.vec3s({0, 0, 0, 1, 2, 0})}}}}});
  RenderDescription d = automatic(false);
  d.scene.reset();
  d.models = {{.file = still.save(), .placement = {}, .choice = {}}};
  Session session(d);
  show(session, d, "first");
  d.models[0].file = moving.save();
  show(session, d, "another folder");
  d.models[0].choice.animation = AnimationTime{};
  show(session, d, "an animation");
  d.models[0].choice.animation->seconds = 0.5;
  show(session, d, "another time");
  d.size = ImageSize{12, 24};
  show(session, d, "another image");
  place(d);
  show(session, d, "placed");
  d.models[0].choice.animation.reset();
  show(session, d, "at rest");
}

// Files are dated by a clock with coarse ticks.
void waitForTick() { std::this_thread::sleep_for(20ms); }

class ChangedFiles : public testing::Test {
 protected:
  ChangedFiles() {
    writeModel(0.75f);
    writeProbe(1);
    description_ = automatic(false);
    description_.scene.reset();
    description_.probe.map.reset();
    description_.probe.file = probe();
    description_.models = {{.file = model(), .placement = {}, .choice = {}}};
  }

  std::string model() const { return model_.folder() / "model.gltf"; }
  std::string probe() const { return model_.folder() / "probe.pfm"; }
  void writeModel(float grey) {
    if (!model_.root.contains("nodes")) {
      model_.add("materials", {{"doubleSided", true}});
      addTriangle(model_, {{"material", 0},
                           {"attributes", {{"TEXCOORD_0", model_.vec2s({0, 0, 1, 0, 0, 1})}}}});
      model_.add("textures", {{"source", 0}});
      model_.add("images", {{"uri", "image.png"}});
      writeTexture(Rgb(1));
    }
    model_.root["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {grey, 0.5, 0.5, 1}},
                                                           {"baseColorTexture", {{"index", 0}}}};
    model_.save();
    waitForTick();
  }
  void writeTexture(Rgb color) {
    Image image(2, 2, 3);
    recolor(image, [&](const Rgb&) { return color; });
    writeImage(model_.folder() / "image.png", image);
    waitForTick();
  }
  void writeProbe(float radiance) {
    writeImage(probe(), constantProbe({16, 8}, Rgb(radiance)));
    waitForTick();
  }

  RenderDescription description_;

 private:
  GltfWriter model_;
};

TEST_F(ChangedFiles, AreReadAgain) {
  Session session(description_);
  const auto work = [&](const char* what) { return show(session, description_, what); };
  work("first");
  description_.camera.orbit = 3;
  description_.probe.rotation = Rotation(20);
  const Session::Work same = work("unchanged");
  EXPECT_FALSE(same.loadedScene || same.loadedProbe);

  writeModel(0.25f);
  EXPECT_TRUE(work("model").loadedScene);
  writeTexture(Rgb(0.1f, 0.2f, 0.9f));
  EXPECT_TRUE(work("texture").loadedScene);
  writeProbe(3);
  const Session::Work lit = work("probe");
  EXPECT_TRUE(lit.loadedProbe && lit.preparedLighting && !lit.loadedScene);
  const Session::Work again = work("nothing");
  EXPECT_FALSE(again.loadedScene || again.loadedProbe);

  const std::string other = probe() + ".pfm";
  std::filesystem::copy_file(probe(), other);
  description_.probe.file = other;
  work("another probe");
  writeProbe(2);
  description_.probe.file = probe();
  work("a probe that changed while another one was used");

  std::filesystem::remove(model());
  session.update(description_);
  session.start();
  EXPECT_THROW(session.wait(), InputError);
  writeModel(0.75f);
  work("model that was missing");
}

// Also of files that another description has read, and whose texels are kept.
TEST_F(ChangedFiles, AreReadAgainAfterAnotherModel) {
  RenderDescription other = automatic(false);
  Session session(description_);
  show(session, description_, "first");
  show(session, other, "other");
  writeTexture(Rgb(0.1f, 0.2f, 0.9f));
  show(session, description_, "texture");
}

TEST(FileStamps, TellChangesFromTheTimeOfReadingOn) {
  const TemporaryFolder folder;
  const std::string file = folder / "file", link = folder / "link", missing = folder / "missing";
  const auto write = [](const std::string& name, const char* text) {
    std::ofstream(name) << text;
    waitForTick();
  };
  write(file, "text");
  std::filesystem::create_symlink(file, link);
  FileStamps stamps;
  EXPECT_FALSE(stamps.isCurrent(file));
  stamps.add({file, link, missing}, FileStamps::now());
  EXPECT_TRUE(stamps.isCurrent(file) && stamps.isCurrent(missing) && stamps.areCurrent());

  const auto date = std::filesystem::last_write_time(file);
  write(file, "next");
  std::filesystem::last_write_time(file, date);
  EXPECT_FALSE(stamps.isCurrent(file) || stamps.isCurrent(link) || stamps.areCurrent());
  write(missing, "text");
  EXPECT_FALSE(stamps.isCurrent(missing));
  stamps.add({file, link, missing}, FileStamps::now());
  EXPECT_TRUE(stamps.areCurrent());
  std::filesystem::rename(missing, file);  // of the same length
  EXPECT_FALSE(stamps.isCurrent(file) || stamps.isCurrent(link));

  const auto begin = FileStamps::now() - 1min;
  write(file, "text");  // perhaps after it was read
  stamps.add({file}, begin);
  EXPECT_FALSE(stamps.isCurrent(file));
}

}  // namespace
}  // namespace chromeball::session_update_test
