// SPDX-License-Identifier: Apache-2.0
// The thread, order and number of a session's callbacks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "base/error.h"
#include "probe/synth.h"
#include "render/render_state.h"
#include "scene/builder/scene_builder.h"
#include "session/live_image.h"
#include "session/render_loaded.h"
#include "session/session.h"
#include "test_scene.h"

namespace chromeball::session_callbacks_test {
namespace {

RenderDescription ballDescription(uint32_t samples = 16) {
  auto scene = std::make_shared<Scene>();
  addSphere(*scene, addMaterial(*scene, lambert(Rgb(0.5f))), {0, 0.5f, 0}, 0.5f, 16);
  addQuad(*scene, 0, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  RenderDescription d;
  d.scene = std::move(scene);
  d.probe.map = std::make_shared<const Image>(gradientProbe({64, 32}, Rgb(0.5f), {0.1, 0.3, 0.2}));
  d.lighting.strategy = "importance";
  d.camera.placed = CameraEntry{.position = {0, 1, 4}, .target = {0, 0.5, 0}, .up = {0, 1, 0}};
  d.size = ImageSize{72, 40};  // tiles at the borders are smaller
  d.settings.samples = samples;
  return d;
}

// All calls of a session, with the threads that they came in.
struct Calls {
  std::vector<std::thread::id> threads;
  std::vector<std::string> stages, messages;
  std::vector<double> fractions;  // of the last stage
  int finished = 0;

  SessionCallbacks callbacks() {
    return {.progress =
                [this](const SessionProgress& p) {
                  EXPECT_EQ(finished, 0);
                  threads.push_back(std::this_thread::get_id());
                  if (stages.empty() || stages.back() != p.stage) {
                    stages.emplace_back(p.stage);
                    fractions.clear();
                  }
                  fractions.push_back(p.fraction);
                },
            .message =
                [this](const Message& message) {
                  EXPECT_EQ(finished, 0);
                  threads.push_back(std::this_thread::get_id());
                  messages.push_back(message.text);
                },
            .finished =
                [this] {
                  threads.push_back(std::this_thread::get_id());
                  ++finished;
                }};
  }
};

TEST(SessionCallbacks, ComeInOneThreadOfTheSession) {
  Calls calls;
  RenderDescription d = ballDescription(64);
  d.probe.map = std::make_shared<const Image>(constantProbe({16, 8}, Rgb(0)));
  d.warnings = {"a warning"};
  Session session(d, calls.callbacks());
  session.start();
  session.wait();
  ASSERT_FALSE(calls.threads.empty());
  for (const std::thread::id& thread : calls.threads) EXPECT_EQ(thread, calls.threads.front());
  EXPECT_NE(calls.threads.front(), std::this_thread::get_id());
  EXPECT_EQ(calls.finished, 1);
  EXPECT_EQ(calls.stages,
            (std::vector<std::string>{"probe", "acceleration structures", "lighting", "render"}));
  EXPECT_EQ(calls.fractions.front(), 0);
  EXPECT_EQ(calls.fractions.back(), 1);
  EXPECT_TRUE(std::ranges::is_sorted(calls.fractions));
  std::vector<std::string> messages;
  for (const Message& message : session.messages()) messages.push_back(message.text);
  EXPECT_FALSE(messages.empty());
  for (const Message& message : session.wait().messages) messages.push_back(message.text);
  EXPECT_EQ(calls.messages, messages);
}

// Where limits took all light, the messages of the image say so, by the words of the program.
TEST(SessionCallbacks, WordsOfMessagesAboutTheImage) {
  RenderDescription d = ballDescription();
  d.settings.maxDiffuseDepth = 0;
  d.settings.clamp = 1e-3f;
  const auto messagesOf = [&](SessionCallbacks callbacks) {
    Calls calls;
    const SettingWords words = callbacks.words;
    callbacks = calls.callbacks();
    callbacks.words = words;
    Session session(d, callbacks);
    session.start();
    std::string all;
    for (const Message& message : session.wait().messages) {
      all += message.text + "\n";
      EXPECT_GT(std::ranges::count(calls.messages, message.text), 0);
    }
    return all;
  };
  const std::string plain = messagesOf({});
  EXPECT_NE(plain.find("`clamp` scaled "), std::string::npos) << plain;
  EXPECT_NE(plain.find("% of the visible surfaces are black: no light reaches them with "
                       "`render.max_diffuse_depth` 0 and `clamp` 0.001; leave them out"),
            std::string::npos)
      << plain;
  EXPECT_EQ(plain.find("--"), std::string::npos) << plain;
  const std::string own = messagesOf({.words = [](std::string_view setting, const std::string& v) {
    return fmt::format("<{}={}>", setting, v);
  }});
  EXPECT_NE(own.find("<clamp=> scaled "), std::string::npos) << own;
  EXPECT_NE(own.find("with <render.max_diffuse_depth=0>"), std::string::npos) << own;
}

TEST(SessionCallbacks, NoSurfaceInViewIsSaid) {
  RenderDescription d = ballDescription();
  d.camera.placed->target = {0, 9, 4.1};
  Session session(d);
  session.start();
  const Messages messages = session.wait().messages;
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].kind, Message::Kind::Warning);
  EXPECT_EQ(messages[0].text, "no surface is in view; try another camera");
}

TEST(SessionCallbacks, FinishedComesOnceForEachStartAlsoOfAFailure) {
  Calls calls;
  RenderDescription d = ballDescription();
  d.lighting.strategy = "none";
  Session session(d, calls.callbacks());
  session.start();
  EXPECT_THROW(session.wait(), InputError);
  EXPECT_EQ(calls.finished, 1);
  calls.finished = 0;
  session.start();
  session.cancel();
  EXPECT_EQ(calls.finished, 1);
}

TEST(SessionCallbacks, WhatTheyThrowIsThrownByWait) {
  for (const std::string wanted : {"lighting", "render"}) {
    Session session(ballDescription(), {.progress = [&](const SessionProgress& p) {
                      if (p.stage == wanted) throw std::domain_error("of a callback");
                    }});
    session.start();
    EXPECT_THROW(session.wait(), std::domain_error);
  }
  Session session(ballDescription(), {.finished = [] { throw std::domain_error("at the end"); }});
  session.start();
  EXPECT_THROW(session.wait(), std::domain_error);
}

TEST(SessionCallbacks, ErrorsOfEntriesFromMemoryNameTheirPlaces) {
  const auto errorOf = [](const RenderDescription& d) -> std::string {
    try {
      Session session(d);
      session.start();
      session.wait();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  RenderDescription d = ballDescription();
  d.lighting.strategy = "none";
  EXPECT_TRUE(errorOf(d).starts_with("lighting.strategy: unknown strategy")) << errorOf(d);
  d = ballDescription();
  d.camera.placed->target = d.camera.placed->position;
  EXPECT_TRUE(errorOf(d).starts_with("camera.placed: ")) << errorOf(d);
  d = ballDescription();
  d.camera.placed->lens.orthographic = true;
  d.camera.lens = Lens{0.1f, 1};
  EXPECT_TRUE(errorOf(d).starts_with("camera.lens: ")) << errorOf(d);
  d.camera.lens.reset();
  d.camera.optics = Optics{};
  EXPECT_TRUE(errorOf(d).starts_with("camera.optics: ")) << errorOf(d);
  d = ballDescription();
  d.sources = {{.name = "window", .corners = {{1, 1}, {3000, 1}, {3, 3}}}};
  EXPECT_TRUE(errorOf(d).starts_with("sources[0]: ")) << errorOf(d);
}

// Watches its own render.
class SelfWatching : public RenderControl {
 public:
  bool restore(RenderState&) override { return false; }
  bool wantsPause(const RenderState&) const override { return false; }
  void pause(RenderState&) override {}
  void end(RenderState&) override {}
  LiveResult* live() override { return &live_; }

 private:
  LiveResult live_;
};

// The image that is updated tile by tile equals the one made from the whole at the end; images
// handed out do not change.
TEST(SessionCallbacks, LiveImageIsThatOfTheWhole) {
  RenderDescription d = ballDescription(32);
  d.settings.crop = Crop{3, 2, 60, 35};
  d.settings.aovs = {Aov::Albedo, Aov::Normal, Aov::Depth, Aov::Samples, Aov::Alpha, Aov::Denoise};
  for (const bool hasGroups : {false, true}) {
    d.settings.lightGroups = hasGroups;
    const LoadedScene loaded = loadScene(d);
    const PreparedScene prepared = prepareScene(loaded);
    SelfWatching control;
    LiveImage image(loaded, *control.live());
    std::vector<std::shared_ptr<const SessionImage>> held;
    std::vector<std::vector<float>> texels;
    const std::atomic<bool> never = false;
    const auto watch = [&](double) {
      auto soFar = image.update(0.5);
      if (!soFar || held.size() >= 4) return;  // later ones take turns in two buffers
      texels.push_back(soFar->color().texels);
      held.push_back(std::move(soFar));
    };
    const FinishedRender result = renderLoaded(loaded, prepared, watch, never, &control);
    ASSERT_EQ(held.size(), 4u);
    for (size_t i = 0; i < held.size(); ++i) EXPECT_EQ(held[i]->color().texels, texels[i]);
    const auto last = image.update(0.5);
    ASSERT_TRUE(last);
    EXPECT_EQ(last->noise, 0.5);
    EXPECT_NEAR(last->samples, 32, 1);
    ASSERT_EQ(last->image.layers.size(), result.image.layers.size());
    for (size_t i = 0; i < last->image.layers.size(); ++i) {
      EXPECT_EQ(last->image.layers[i].name, result.image.layers[i].name);
      EXPECT_EQ(last->image.layers[i].image.texels, result.image.layers[i].image.texels)
          << last->image.layers[i].name;
    }
    ASSERT_TRUE(last->image.placement);
    EXPECT_EQ(last->image.placement->x, 3);
  }
}

// A composite is composed anew of all its pixels: its ratios depend on the mean of the image.
TEST(SessionCallbacks, LiveImageOfACompositeIsThatOfTheWhole) {
  for (const CompositeMode mode :
       {CompositeMode::ShadowCatcher, CompositeMode::Difference, CompositeMode::Ratio}) {
    RenderDescription d = ballDescription(32);
    CompositeDescription& composite = d.composite.emplace();
    composite.mode = mode;
    composite.ground = CompositeDescription::GroundPlane::Always;
    composite.layers = {"l_obj"};
    if (mode != CompositeMode::ShadowCatcher) composite.plate = constantProbe({72, 40}, Rgb(0.4f));
    const LoadedScene loaded = loadScene(d);
    const PreparedScene prepared = prepareScene(loaded);
    SelfWatching control;
    LiveImage image(loaded, *control.live());
    const std::atomic<bool> never = false;
    int seen = 0;
    const FinishedRender result = renderLoaded(
        loaded, prepared, [&](double) { seen += image.update(0.5) != nullptr; }, never, &control);
    EXPECT_GT(seen, 1);
    const auto last = image.update(0.5);
    ASSERT_TRUE(last);
    ASSERT_EQ(last->image.layers.size(), result.image.layers.size());
    for (size_t i = 0; i < last->image.layers.size(); ++i)
      EXPECT_EQ(last->image.layers[i].image.texels, result.image.layers[i].image.texels)
          << int(mode) << " " << last->image.layers[i].name;
  }
}

}  // namespace
}  // namespace chromeball::session_callbacks_test
