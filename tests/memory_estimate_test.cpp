// SPDX-License-Identifier: Apache-2.0
// The memory that a render will take is stated before, agrees with the measured one, and is refused
// if it is too much. Small scenes: the numbers of large ones are in docs/measured/results.md.
#include "session/memory_estimate.h"
#include "base/json.h"

#include <gtest/gtest.h>

#include <fstream>

#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::memory_estimate_test {
namespace {

using Words = std::vector<std::string>;

class SlowMemoryEstimate : public testing::Test {
 protected:
  void SetUp() override {
    addTriangle(small_);
    model_ = small_.save();
    probe_ = (small_.folder() / "probe.exr").string();
    writeImage(probe_, constantProbe({8, 4}, Rgb(1)));
  }

  Words words(const std::string& model, const std::string& probe, const Words& more) const {
    Words all{"render", model, "--probe",      probe,     "--samples",
              "2",      "-o",  out_ / "a.exr", "--stats", out_ / "a.json"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  // The large scene takes so much more than a small one that its category decides.
  void expectStated(const std::string& model, const std::string& probe, const Words& more) {
    const auto memory = [&](const Words& arguments) {
      const CommandResult result = runExecutable(arguments);  // a fork shares memory
      EXPECT_EQ(result.status, 0) << result.error;
      return jsonOfFile(out_ / "a.json")["memory"];
    };
    const auto small = memory(words(model_, probe_, {"--size", "8x8"}));
    const auto large = memory(words(model, probe, more));
    const double measured = large["measured_peak"].get<double>();
    EXPECT_GT(measured, small["measured_peak"].get<double>() + 1e8) << "too small to be measured";
    EXPECT_NEAR(large["stated_peak"].get<double>() / measured, 1, 0.25) << jsonText(large);
  }

  void expectRefused(const std::string& model, const std::string& probe, const Words& more,
                     const std::string& reason) {
    const CommandResult result = expectError(words(model, probe, more), reason);
    EXPECT_NE(result.error.find("--memory"), std::string::npos) << result.error;
  }

  const TemporaryFolder out_;
  GltfWriter small_;
  std::string model_, probe_;
};

TEST_F(SlowMemoryEstimate, OfImages) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  expectStated(model_, probe_,
               {"--size", "1000x600", "--aov",
                "albedo,normal,depth,alpha,variance,samples,material,node,invalid,denoise"});
}

TEST_F(SlowMemoryEstimate, OfAProbe) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const std::string probe = (small_.folder() / "large.exr").string();
  writeImage(probe, constantProbe({4096, 2048}, Rgb(1)));
  expectStated(model_, probe, {"--size", "8x8"});
  expectRefused(model_, probe, {"--memory", "0.2", "--size", "8x8"}, "takes 0.");
}

// Adds a node with a wavy sheet of 2 side^2 triangles.
int addSheet(GltfWriter& w, int side, const nlohmann::json& more) {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      const float height = 20 * std::sin(0.01f * float(x)) * std::cos(0.02f * float(y));
      positions.insert(positions.end(), {float(x), height, float(y)});
      const uint32_t i = uint32_t(y * (side + 1) + x), next = i + uint32_t(side) + 1;
      if (x < side && y < side)
        indices.insert(indices.end(), {i, next, i + 1, i + 1, next, next + 1});
    }
  const int count = int(indices.size());
  nlohmann::json primitive = {
      {"attributes", {{"POSITION", w.vec3s(positions)}}},
      {"indices", w.accessor(w.view(indices), kUInt, "SCALAR", size_t(count))}};
  primitive.update(more);
  return addTriangle(w, primitive);
}

TEST_F(SlowMemoryEstimate, OfGeometry) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  GltfWriter w;
  addSheet(w, 1000, nlohmann::json::object());
  const std::string model = w.save();
  expectStated(model, probe_, {"--size", "8x8"});
  expectRefused(model, probe_, {"--memory", "0.2", "--size", "8x8"}, "geometry");
}

// Each placed triangle is a lamp of its own, and a bake has the vertices of each instance.
TEST_F(SlowMemoryEstimate, OfInstancesThatEmit) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  GltfWriter w;
  w.add("materials", {{"emissiveFactor", {1, 1, 1}}});
  const int node = addSheet(w, 200, {{"material", 0}});
  for (int i = 1; i < 40; ++i)
    w.add("nodes",
          {{"mesh", w.root["nodes"][size_t(node)]["mesh"]}, {"translation", {0, 30 * i, 0}}});
  const std::string model = w.save();
  expectStated(model, probe_, {"--size", "8x8"});
  expectRefused(model, probe_, {"--memory", "0.2", "--size", "8x8"}, "geometry");
  expectError({"bake", model, "--to", "vertices", "--memory", "0.5", "-o", out_ / "a.glb"},
              "40 instances with 3200000 triangles apart take");
}

TEST_F(SlowMemoryEstimate, TexturesAreRefusedByTheirHeaders) {
  constexpr int kSide = 4096;
  small_.write("a.png", encodePng(kSide, kSide, 1, std::vector<uint8_t>(kSide * kSide)));
  small_.add("images", {{"uri", "a.png"}});
  small_.add("textures", {{"source", 0}});
  small_.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  addTriangle(small_, {{"material", 0}});
  expectRefused(small_.save(), probe_, {"--memory", "0.05", "--size", "8x8"},
                "its textures take 0.0895 GB of memory; the limit is 0.05 GB");
}

TEST(MemoryEstimate, OfAPixelIsThatOfTheEnvelope) {
  const std::string page = fileContents(std::string(kSourceDir) + "/tests/ENVELOPE.md");
  constexpr std::string_view kBefore = "a pixel takes about ";
  const size_t at = page.find(kBefore);
  ASSERT_NE(at, std::string::npos);
  RenderSettings settings;
  settings.width = settings.height = 1;
  EXPECT_NEAR(std::stod(page.substr(at + kBefore.size())) / imageBytes(settings), 1, 0.02);
}

}  // namespace
}  // namespace chromeball::memory_estimate_test
