// SPDX-License-Identifier: Apache-2.0
// Renders that stop between tiles and continue from the stored state.
#include <gtest/gtest.h>

#include "base/archive.h"
#include "base/error.h"
#include "render/render_state.h"
#include "small_scenes.h"

namespace chromeball::resume_test {
namespace {

constexpr int kWidth = 48, kHeight = 36;
const Camera kCamera = Camera::lookAt({0, 1.5f, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.8f);

// Stores the state after some tiles, and stops the render there; continues from another.
class StopAfter : public RenderControl {
 public:
  StopAfter(int tiles, std::atomic<bool>& stop) : tiles_(tiles), stop_(stop) {}

  std::vector<char> stored;

  bool restore(RenderState& state) override {
    if (stored.empty()) return false;
    MemoryReader reader(stored);
    state.archive(reader);
    EXPECT_EQ(reader.left(), 0u);
    stored.clear();
    return true;
  }
  bool wantsPause(const RenderState& state) const override {
    return state.canBeStored() && ++asked_ > tiles_;
  }
  void pause(RenderState& state) override {
    end(state);
    stop_ = true;
  }
  void end(RenderState& state) override {
    MemoryWriter writer;
    state.archive(writer);
    stored = std::move(writer.contents);
  }

 private:
  int tiles_;
  std::atomic<bool>& stop_;
  mutable std::atomic<int> asked_ = 0;
};

struct Stopped {
  RenderResult result;
  int times = 0;
};

// Stops again and again after so many tiles.
Stopped renderInPieces(const World& world, const LightSource& lighting,
                       const RenderSettings& settings, int tiles) {
  std::vector<char> stored;
  for (int times = 0;; ++times) {
    std::atomic<bool> stop = false;
    StopAfter control(tiles, stop);
    control.stored = stored;
    RenderResult result = render(
        world, kCamera, lighting, settings, [](double) {}, stop, &control);
    if (!result.interrupted) return {std::move(result), times};
    if (times > 1000) throw std::logic_error("the render does not go on");
    stored = control.stored;
  }
}

RenderSettings fullSettings() {
  RenderSettings settings = smallRender(kWidth, kHeight, 64, 4);
  settings.aovs = {Aov::Albedo, Aov::Normal, Aov::Depth, Aov::Node, Aov::Invalid};
  settings.denoise = true;
  settings.regularize = true;
  return settings;
}

void expectSame(const RenderResult& a, const RenderResult& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.film.mean().texels, b.film.mean().texels);
  EXPECT_EQ(a.film.errors().scatter, b.film.errors().scatter);
  EXPECT_EQ(a.film.sampleCounts().texels, b.film.sampleCounts().texels);
  for (const Aov aov : {Aov::Albedo, Aov::Normal, Aov::Depth, Aov::Node, Aov::Invalid})
    EXPECT_EQ(a.aovs.finished(aov).texels, b.aovs.finished(aov).texels);
  EXPECT_EQ(a.features.direct().half.texels, b.features.direct().half.texels);
  EXPECT_EQ(a.adaptive, b.adaptive);
  EXPECT_EQ(a.guidedRegions, b.guidedRegions);
  EXPECT_EQ(a.causticFraction, b.causticFraction);
  EXPECT_EQ(a.rays.camera, b.rays.camera);
  EXPECT_EQ(a.rays.bounce, b.rays.bounce);
}

TEST(SlowResume, GivesTheBitsOfAnUninterruptedRender) {
  const NamedScene small = threeScenes()[2];
  const Probe probe(small.probe);
  for (const bool adaptive : {false, true})
    for (const Guiding guiding : {Guiding::Off, Guiding::On}) {
      RenderSettings settings = fullSettings();
      settings.adaptive = adaptive;
      settings.guiding = guiding;
      const World world(small.scene, {}, BsdfTables(small.scene.materials, true));
      const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
      const std::atomic<bool> never = false;
      const RenderResult whole = render(
          world, kCamera, *lighting, settings, [](double) {}, never);
      EXPECT_EQ(whole.causticFraction > 0, guiding == Guiding::On);
      for (const int tiles : {3, 8}) {
        const Stopped pieces = renderInPieces(world, *lighting, settings, tiles);
        EXPECT_GE(pieces.times, 2);
        expectSame(pieces.result, whole);
      }
    }
}

TEST(Resume, GoesOnWithMoreSamples) {
  const NamedScene small = threeScenes()[0];
  const Probe probe(small.probe);
  RenderSettings settings = smallRender(kWidth, kHeight, 16, 4);
  settings.adaptive = false;
  const World world(small.scene);
  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  std::atomic<bool> stop = false;
  StopAfter control(1 << 30, stop);
  render(
      world, kCamera, *lighting, settings, [](double) {}, stop, &control);
  ASSERT_FALSE(control.stored.empty());
  settings.samples = 64;
  const RenderResult more = render(
      world, kCamera, *lighting, settings, [](double) {}, stop, &control);
  EXPECT_EQ(more.samples, 64u);
  for (const float count : more.film.sampleCounts().texels) ASSERT_EQ(count, 64);
  const RenderResult whole = render(
      world, kCamera, *lighting, settings, [](double) {}, stop);
  EXPECT_LT(more.film.noise().noise, 1.2 * whole.film.noise().noise);
}

// A state with any byte changed is refused or gives some image, but does not crash.
TEST(Resume, SurvivesDamagedStates) {
  const NamedScene small = threeScenes()[2];
  const Probe probe(small.probe);
  RenderSettings settings = smallRender(16, 16, 32, 3);
  settings.guiding = Guiding::On;
  const World world(small.scene);
  const auto lighting = makeStrategy("importance", probe, settings.mis, "test");
  std::atomic<bool> stop = false;
  StopAfter control(1 << 30, stop);
  render(
      world, kCamera, *lighting, settings, [](double) {}, stop, &control);
  const std::vector<char> stored = control.stored;
  settings.samples = 33;
  int refused = 0;
  for (uint64_t i = 0; i < 300; ++i) {
    control.stored = stored;
    control.stored[hash(i, 1) % stored.size()] ^= char(1 + hash(i, 2) % 255);
    if (i % 10 == 0) control.stored.resize(hash(i, 3) % stored.size());
    try {
      render(
          world, kCamera, *lighting, settings, [](double) {}, stop, &control);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GE(refused, 30);
}

}  // namespace
}  // namespace chromeball::resume_test
