// SPDX-License-Identifier: Apache-2.0
// A thousand sessions in one process, which end in all ways, leave nothing behind.
#include <gtest/gtest.h>
#include <malloc.h>

#include <filesystem>
#include <iterator>
#include <thread>

#include "base/error.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "probe/synth.h"
#include "session/session.h"

namespace chromeball::session_leak_test {
namespace {

size_t entriesOf(const char* folder) {
  return size_t(std::distance(std::filesystem::directory_iterator(folder), {}));
}

struct Holdings {
  size_t bytes, descriptors, threads;

  static Holdings now() {
    const struct mallinfo2 info = mallinfo2();
    return {info.uordblks + info.hblkhd, entriesOf("/proc/self/fd"), entriesOf("/proc/self/task")};
  }
};

std::string texturedModel(GltfWriter& w) {
  w.write("a.png", encodePng(64, 64, 3, std::vector<uint8_t>(size_t(64 * 64 * 3), 90)));
  w.add("images", {{"uri", "a.png"}});
  w.add("textures", {{"source", 0}});
  w.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const int uvs = w.vec2s({0, 0, 1, 0, 0, 1});
  addTriangle(w, {{"material", 0}, {"attributes", {{"TEXCOORD_0", uvs}}}});
  return w.save();
}

// The ways in which sessions end, in turn.
void runSession(int number, const RenderDescription& description) {
  static const std::vector<std::string> kStages = {
      "models", "textures", "probe", "acceleration structures", "lighting", "render"};
  const std::string stage = number % 2 ? kStages[size_t(number / 2) % kStages.size()] : "";
  RenderDescription d = description;
  const bool isLong = number % 4 == 0;
  if (isLong) d.settings.samples = kMaxSamples;
  Session* own = nullptr;
  Session session(d, {.progress = [&](const SessionProgress& p) {
                    if (p.stage == stage) own->requestCancel();
                  }});
  own = &session;
  session.start();
  if (isLong) {  // destroyed, or changed, while it renders
    while (!session.snapshot()) std::this_thread::yield();
    if (number % 8 == 0) return;
    d.settings.samples = 1;
    d.probe.rotation = Rotation(90);
    session.update(d);
    session.start();
  }
  try {
    session.wait();
    EXPECT_TRUE(stage.empty() || stage == "render");
  } catch (const Interrupted&) {
    EXPECT_FALSE(stage.empty());
  }
}

TEST(SlowSession, AThousandLeaveNothingBehind) {
  GltfWriter w;
  RenderDescription d;
  ModelEntry model;
  model.file = texturedModel(w);
  d.models.push_back(model);
  d.probe.file = (w.folder() / "probe.exr").string();
  writeImage(*d.probe.file, gradientProbe({128, 64}, Rgb(1), {0.3, 0.2, 0.1}));
  d.lighting.strategy = "importance";
  d.size = ImageSize{32, 32};
  d.settings.samples = 2;
  constexpr int kCount = kIsInstrumented ? 100 : 1000;
  for (int i = 0; i < kCount / 2; ++i) runSession(i, d);
  const Holdings half = Holdings::now();
  for (int i = kCount / 2; i < kCount; ++i) runSession(i, d);
  const Holdings all = Holdings::now();
  EXPECT_EQ(all.descriptors, half.descriptors);
  EXPECT_LE(all.threads, half.threads);
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  // Embree keeps some 210 bytes for each thread that has ever built a structure, and a session has
  // its own thread. The remaining memory is less than any part of one session takes: the probe's
  // map has 98 kB.
  constexpr double kOfAThread = 256;
  EXPECT_LT(double(all.bytes) - double(half.bytes), 2e4 + kOfAThread * kCount / 2);
}

}  // namespace
}  // namespace chromeball::session_leak_test
