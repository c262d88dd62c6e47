// Real models under real probes: every sample of every picture is valid.
#include <gtest/gtest.h>

#include "math/error.h"
#include "probe/load.h"
#include "scene/framing.h"
#include "scene/gltf.h"
#include "shared_data.h"
#include "test_scene.h"

namespace chromeball {
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

void expectValid(const Scene& scene, const Probe& probe, const fs::path& file) {
  const Camera camera = scene.cameras.empty() ? framingCamera(scene, 1) : scene.cameras.front();
  const RenderResult r = renderScene(scene, camera, probe, "importance", smallRender(32, 32, 4, 8));
  EXPECT_EQ(r.invalid.total(), 0u)
      << file << ": " << r.invalid.of(Defect::Nan) << " NaN, " << r.invalid.of(Defect::Infinite)
      << " infinite, " << r.invalid.of(Defect::Negative) << " negative, the first at "
      << r.invalid.x << ' ' << r.invalid.y;
}

TEST(SlowModels, EveryModelRendersWithoutAnInvalidSample) {
  const auto models = sharedData("gltf");
  const auto map = sharedData("probes/probulator/grace_latlong_small.hdr");
  if (!models || !map) GTEST_SKIP() << "../shared/data/gltf or its probes are not there";
  const Probe probe(loadProbe(*map, "lat-long", "").latLong);
  int rendered = 0;
  for (const fs::path& file : filesBelow(*models, {".gltf", ".glb"})) {
    try {
      const Scene scene = loadGltf(file.string(), {}, nullptr);
      if (scene.instances.empty()) continue;
      expectValid(scene, probe, file);
      ++rendered;
    } catch (const InputError&) {
      // What is refused, and why, is gltf_samples_test's.
    }
  }
  EXPECT_GT(rendered, 60);
}

TEST(SlowModels, EveryProbeLightsWithoutAnInvalidSample) {
  const auto probes = sharedData("probes");
  const auto model = sharedData("gltf/DamagedHelmet/glTF/DamagedHelmet.gltf");
  if (!probes || !model) GTEST_SKIP() << "../shared/data/probes or its models are not there";
  const Scene scene = loadGltf(model->string(), {}, nullptr);
  int lit = 0;
  for (const fs::path& file : filesBelow(*probes, {".hdr", ".exr"})) {
    if (file.string().find("/pisaHDR/") != std::string::npos) continue;  // single faces of a cube
    const Probe probe(loadProbe(file, "auto", "").latLong);
    expectValid(scene, probe, file);
    ++lit;
  }
  EXPECT_GT(lit, 25);
}

}  // namespace
}  // namespace chromeball
