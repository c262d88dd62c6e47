// SPDX-License-Identifier: Apache-2.0
// Cancellation while a scene is prepared: the amount of work done after it, and the state that
// remains. Time is not measured here.
#include <gtest/gtest.h>

#include <mutex>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/builder/scene_builder.h"
#include "scene/gltf/model_cache.h"
#include "session/render_loaded.h"
#include "session/session.h"
#include "test_scene.h"

namespace chromeball::session_cancel_test {
namespace {

// Cancels the work when it has been asked for the `limit`-th time.
class Countdown : public WorkMonitor {
 public:
  explicit Countdown(size_t limit) : limit_(limit) {}

  bool isCancelled() const override { return ++asked_ > limit_; }
  void report(const char* stage, double fraction) override {
    const std::scoped_lock lock(reporting_);
    if (stages_.empty() || stages_.back() != stage) stages_.emplace_back(stage);
    EXPECT_TRUE(fraction >= 0 && fraction <= 1) << stage;
  }

  size_t asked() const { return asked_; }
  size_t askedAfterwards() const { return asked_ > limit_ ? asked_ - limit_ : 0; }
  const std::vector<std::string>& stages() const { return stages_; }

 private:
  const size_t limit_;
  mutable std::atomic<size_t> asked_ = 0;
  std::mutex reporting_;
  std::vector<std::string> stages_;
};

// The picture of the prepared scene.
Image prepareAndRender(const RenderDescription& description, ModelCache& cache,
                       WorkMonitor* monitor) {
  std::optional<LoadedScene> loaded;
  PreparedScene prepared;
  {
    const MonitoredWork work(monitor);
    loaded.emplace(loadScene(description, &cache));
    prepared = prepareScene(*loaded);
  }
  const std::atomic<bool> never = false;
  return renderLoaded(
             *loaded, prepared, [](double) {}, never)
      .color();
}

// Cancels at several points of the preparation. `units`: the least number of parts that it must
// consist of.
void expectCancels(const RenderDescription& description, const std::string& stage, size_t units) {
  constexpr size_t kNever = std::numeric_limits<size_t>::max() / 2;
  Countdown whole(kNever);
  ModelCache first;
  const Image picture = prepareAndRender(description, first, &whole);
  EXPECT_GE(whole.asked(), units) << stage;
  EXPECT_EQ(std::ranges::count(whole.stages(), stage), 1) << stage;
  constexpr size_t kPoints = 6;
  for (size_t i = 0; i < kPoints; ++i) {
    Countdown countdown(whole.asked() * i / (kPoints + 1));
    ModelCache cache;
    EXPECT_THROW(prepareAndRender(description, cache, &countdown), Interrupted) << stage << i;
    // Each thread ends the part that it is in, of each loop around it.
    EXPECT_LE(countdown.askedAfterwards(), 4 * size_t(threadCount()) + 4) << stage << i;
  }
  ModelCache last;
  EXPECT_EQ(prepareAndRender(description, last, nullptr).texels, picture.texels) << stage;
}

class SessionCancel : public testing::Test {
 protected:
  RenderDescription description(const std::string& model) const {
    RenderDescription d;
    ModelEntry entry;
    entry.file = model;
    d.models.push_back(entry);
    d.probe.map = std::make_shared<const Image>(gradientProbe({64, 32}, Rgb(1), {0.3, 0.2, 0.1}));
    d.lighting.strategy = "importance";
    d.size = ImageSize{8, 8};
    d.settings.samples = 2;
    return d;
  }

  std::string triangle() {
    addTriangle(writer_);
    return writer_.save();
  }

  GltfWriter writer_;
};

class SlowSessionCancel : public SessionCancel {};

TEST_F(SlowSessionCancel, WhileAProbeIsRead) {
  constexpr ImageSize kSize{512, 256};
  for (const char* name : {"probe.exr", "probe.hdr", "probe.png"}) {
    RenderDescription d = description(triangle());
    d.probe.map.reset();
    d.probe.file = (writer_.folder() / name).string();
    writeImage(*d.probe.file, gradientProbe(kSize, Rgb(0.5f), {0.1, 0.2, 0.1}));
    expectCancels(d, "probe", kSize.height);
  }
}

TEST_F(SlowSessionCancel, WhileTexturesAreDecoded) {
  constexpr int kSide = 64, kCount = 24;
  for (int i = 0; i < kCount; ++i) {
    const std::string name = fmt::format("{}.png", i);
    writer_.write(name, encodePng(kSide, kSide, 3, std::vector<uint8_t>(3 * kSide * kSide, 99)));
    writer_.add("images", {{"uri", name}});
    writer_.add("textures", {{"source", i}});
    writer_.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    const int positions = writer_.vec3s({0, 0, 0, 1, 0, 0, 0, 1, float(i)});
    const int uvs = writer_.vec2s({0, 0, 1, 0, 0, 1});
    writer_.add(
        "nodes",
        {{"mesh", writer_.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uvs}}},
                                {"material", i}})}});
  }
  nlohmann::json nodes = nlohmann::json::array();
  for (int i = 0; i < kCount; ++i) nodes.push_back(i);
  writer_.root["scenes"] = {{{"nodes", nodes}}};
  writer_.root["scene"] = 0;
  expectCancels(description(writer_.save()), "textures", size_t(kSide) * kCount);
}

TEST_F(SlowSessionCancel, WhileTrianglesAreBuilt) {
  constexpr int kSide = 300;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) {
      positions.insert(positions.end(), {float(x), std::sin(0.1f * float(x * y)), float(y)});
      const uint32_t i = uint32_t(y * (kSide + 1) + x), next = i + kSide + 1;
      if (x < kSide && y < kSide)
        indices.insert(indices.end(), {i, next, i + 1, i + 1, next, next + 1});
    }
  addTriangle(
      writer_,
      {{"attributes", {{"POSITION", writer_.vec3s(positions)}}},
       {"indices", writer_.accessor(writer_.view(indices), kUInt, "SCALAR", indices.size())}});
  expectCancels(description(writer_.save()), "acceleration structures", 50);
}

TEST_F(SlowSessionCancel, WhileLightsArePlaced) {
  for (const char* strategy : {"importance", "product", "suns", "median-cut:1024", "lightgen:64",
                               "kollig-keller:32", "penrose:300", "irradiance-fit:16"}) {
    RenderDescription d = description(triangle());
    d.probe.map =
        std::make_shared<const Image>(gradientProbe({256, 128}, Rgb(0.5f), {0.1, 0.2, 0.1}));
    d.lighting.strategy = strategy;
    expectCancels(d, "lighting", 50);
  }
}

// What was loaded before a change stays, if only the change was cancelled.
TEST_F(SessionCancel, AChangeThatIsCancelledLosesNothing) {
  RenderDescription d = description(triangle());
  std::string stage;
  Session* own = nullptr;
  Session session(d, {.progress = [&](const SessionProgress& p) {
                    if (p.stage == stage) own->requestCancel();
                  }});
  own = &session;
  session.start();
  session.wait();
  d.lighting.strategy = "median-cut:16";
  d.probe.rotation = Rotation(50);
  session.update(d);
  stage = "lighting";
  session.start();
  EXPECT_THROW(session.wait(), Interrupted);
  EXPECT_FALSE(session.work().loadedScene);
  stage = "";
  session.start();
  EXPECT_EQ(session.wait().color().texels, renderLoaded(loadScene(d)).color().texels);
  EXPECT_FALSE(session.work().loadedScene);
  EXPECT_TRUE(session.work().preparedLighting);
}

// In each stage in turn, from a callback: no later stage begins.
TEST_F(SessionCancel, EndsInTheStageInWhichItIsAsked) {
  RenderDescription d = description(triangle());
  d.probe.map.reset();
  d.probe.file = (writer_.folder() / "probe.exr").string();
  writeImage(*d.probe.file, gradientProbe({64, 32}, Rgb(0.5f), {0.1, 0.2, 0.1}));
  for (const std::string wanted : {"models", "probe", "acceleration structures", "lighting"}) {
    std::vector<std::string> stages;
    Session* own = nullptr;
    Session session(d, {.progress = [&](const SessionProgress& p) {
                      if (stages.empty() || stages.back() != p.stage) stages.emplace_back(p.stage);
                      if (p.stage == wanted) own->requestCancel();
                    }});
    own = &session;
    session.start();
    EXPECT_THROW(session.wait(), Interrupted);
    ASSERT_FALSE(stages.empty());
    EXPECT_EQ(stages.back(), wanted);
    EXPECT_FALSE(session.snapshot());
  }
}

}  // namespace
}  // namespace chromeball::session_cancel_test
