// SPDX-License-Identifier: Apache-2.0
// Real models lit by real probes: every sample of every render is valid.
#include <gtest/gtest.h>

#include <deque>

#include "base/error.h"
#include "probe/load.h"
#include "scene/framing.h"
#include "scene/gltf/load_gltf.h"
#include "shared_data.h"
#include "test_scene.h"

namespace chromeball::models_test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> filesBelow(const fs::path& root, std::initializer_list<const char*> endings) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    for (const char* ending : endings)
      if (entry.is_regular_file() && entry.path().extension() == ending)
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

struct LitBy {
  fs::path file;
  std::unique_ptr<LightSource> lighting;
};

std::vector<LitBy> everyProbe(const fs::path& root, std::deque<Probe>& probes) {
  std::vector<LitBy> lit;
  for (const fs::path& file : filesBelow(root, {".hdr", ".exr"})) {
    if (file.string().find("/pisaHDR/") != std::string::npos) continue;  // single faces of a cube
    probes.emplace_back(loadProbe(file, "auto", "").latLong);
    lit.push_back({file, makeStrategy("importance", probes.back(), Mis::Balance, "test")});
  }
  return lit;
}

TEST(SlowModels, EveryModelUnderEveryProbeHasNoInvalidSample) {
  const auto models = sharedData("gltf"), maps = sharedData("probes");
  if (!models || !maps) GTEST_SKIP() << "../shared/data/gltf or its probes are not there";
  std::deque<Probe> probes;
  const std::vector<LitBy> lit = everyProbe(*maps, probes);
  const RenderSettings settings = smallRender(16, 16, 4, 8);
  const std::atomic<bool> stop = false;
  int rendered = 0;
  for (const fs::path& file : filesBelow(*models, {".gltf", ".glb"})) {
    Scene scene;
    try {
      scene = loadGltf(file.string(), {}, nullptr);
    } catch (const InputError&) {
      continue;  // gltf_samples_test checks which models are rejected
    }
    if (scene.instances.empty()) continue;
    ++rendered;
    const World world(scene, {}, allTables());
    const Camera camera = scene.cameras.empty() ? framingCamera(scene, 1) : scene.cameras.front();
    for (const LitBy& by : lit) {
      const RenderResult r = render(
          world, camera, *by.lighting, settings, [](double) {}, stop);
      EXPECT_EQ(r.invalid.total(), 0u)
          << file << " under " << by.file << ": " << r.invalid.of(Defect::Nan) << " NaN, "
          << r.invalid.of(Defect::Infinite) << " infinite, " << r.invalid.of(Defect::Negative)
          << " negative, the first at " << r.invalid.x << ' ' << r.invalid.y;
    }
  }
  EXPECT_GT(lit.size(), 25u);
  EXPECT_GT(rendered, 60);
}

}  // namespace
}  // namespace chromeball::models_test
