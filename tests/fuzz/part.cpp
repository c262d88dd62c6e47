// SPDX-License-Identifier: Apache-2.0
// Parts of renders and checkpoints: as files; and, since hardly a change of a file gets past its
// checksum, by their contents: a byte 1, the number of the blocks, the lengths of the blocks and of
// the head, two bytes each, the blocks, the head (image/io/exr_state.h).
#include <algorithm>
#include <array>
#include <fstream>

#include "fuzz.h"
#include "image/io/exr_state.h"
#include "lighting/methods.h"
#include "parts/merge.h"
#include "probe/synth.h"
#include "render/render_state.h"
#include "session/finish.h"

namespace chromeball {
namespace {

constexpr int kMaxPixels = 1024;  // of images that are made
constexpr uint32_t kMaxSamples = 16;
constexpr size_t kMaxBlocks = 16;

// The scene for which a checkpoint is restored: a quad under a gradient, with guides.
struct SmallWorld {
  static Scene quad() {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodeNames.push_back("quad");
    Mesh mesh;
    mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({0, 0, 0, {}});
    return scene;
  }
  const Scene scene = quad();
  const World world{scene, {}, BsdfTables(scene.materials, true)};
  const Probe probe{gradientProbe({16, 8}, Rgb(0.5f), {0.1, 0.2, 0.3})};
  const std::unique_ptr<LightSource> lighting =
      makeStrategy("importance", probe, Mis::Balance, "fuzz");
  const Camera camera = Camera::lookAt({0, 1, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f);
};

// Stops after the pass that the checkpoint was in.
class Restored : public RenderControl {
 public:
  Restored(const std::string& path, std::atomic<bool>& stop) : path_(path), stop_(stop) {}
  bool restore(RenderState& state) override {
    readExrState(path_, [&](Archive& a) {
      RenderPart part;
      part.archive(a);
      part.plan.archiveImages(a);
      state.archive(a);
    });
    stop_ = state.wanted > kMaxSamples;
    return true;
  }
  void endPass(const RenderState&) override { stop_ = true; }
  bool wantsPause(const RenderState&) const override { return false; }
  void pause(RenderState&) override {}
  void end(RenderState&) override {}

 private:
  std::string path_;
  std::atomic<bool>& stop_;
};

void resume(const std::string& path, RenderSettings settings) {
  static const SmallWorld small;
  settings.guiding = Guiding::On;
  settings.samples = kMaxSamples;
  std::atomic<bool> stop = false;
  Restored control(path, stop);
  render(
      small.world, small.camera, *small.lighting, settings, [](double) {}, stop, &control);
}

void readAll(const std::string& path) {
  const FinishPlan plan = readPartHeader(path).plan;
  const Crop window = plan.settings.window();
  if (window.width > kMaxPixels / window.height) return;
  readOrReject([&] {
    const PartSet parts({path});
    const MergedParts merged = merge(parts, [](double) {});
    const std::atomic<bool> never = false;
    finish(
        merged.part.plan, merged.result, [](double) {}, never);
  });
  if (!plan.composite) readOrReject([&] { resume(path, plan.settings); });
}

// Returns nothing if the bytes are no such contents.
std::string fileOf(std::span<const uint8_t> contents) {
  const auto number = [&]() -> size_t {
    if (contents.size() < 2) return 0;
    const size_t value = contents[0] + 256u * contents[1];
    contents = contents.subspan(2);
    return value;
  };
  const auto put = [](Archive& a, std::span<const uint8_t> bytes) {
    std::array<uint8_t, 64> several;  // much faster than one by one
    for (; bytes.size() >= several.size(); bytes = bytes.subspan(several.size())) {
      std::copy_n(bytes.begin(), several.size(), several.begin());
      a(several);
    }
    for (uint8_t byte : bytes) a(byte);
  };
  const auto take = [&](size_t count) {
    const auto bytes = contents.first(std::min(count, contents.size()));
    contents = contents.subspan(bytes.size());
    return bytes;
  };
  std::vector<size_t> lengths(number() % kMaxBlocks);
  for (size_t& length : lengths) length = number();
  const size_t head = number();
  std::vector<std::span<const uint8_t>> blocks;
  for (const size_t length : lengths) blocks.push_back(take(length));
  const std::string path = fuzzFile(nullptr, 0, "part.exr");
  appendExrState(path, path, [&](Archive& a) {
    a.blocks(blocks.size(), [&](Archive& block, size_t i) { put(block, blocks[i]); });
    put(a, take(head));
  });
  return path;
}

}  // namespace
}  // namespace chromeball

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  return readOrReject([&] {
    readAll(size > 0 && bytes[0] == 1 ? fileOf(std::span(bytes, size).subspan(1))
                                      : fuzzFile(bytes, size, "part.exr"));
  });
}
