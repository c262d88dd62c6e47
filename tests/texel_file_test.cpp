// SPDX-License-Identifier: Apache-2.0
// Textures in a temporary file (--texture-memory): the same bits, in bounded memory, and no failure
// to write or read that goes unnoticed.
#include "image/io/texel_file.h"
#include "base/json.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "json_file.h"
#include "run_command.h"
#include "scene/texture.h"
#include "session/render_loaded.h"
#include "shared_data.h"

namespace chromeball::texel_file_test {
namespace {

using Words = std::vector<std::string>;
using Texel8 = TexelFile::Texel8;

const std::string kProbe = std::string(kSourceDir) + "/probes/dusk.exr";

Texel8 texelAt(uint64_t i) {
  const uint64_t bits = hash(i);
  return {uint8_t(bits), uint8_t(bits >> 8), uint8_t(bits >> 16), uint8_t(bits >> 24)};
}

std::vector<Texel8> texels8(size_t count, uint64_t seed = 0) {
  std::vector<Texel8> texels(count);
  for (size_t i = 0; i < count; ++i) texels[i] = texelAt(seed + i);
  return texels;
}

std::vector<vec4> texelsFloat(size_t count) {
  std::vector<vec4> texels;
  for (const Texel8& t : texels8(count)) texels.push_back(vec4(t[0], t[1], t[2], t[3]) / 256.0f);
  return texels;
}

// The descriptor of this process's file of texels.
int openTexelFile() {
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const std::string target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.find("chromeball-texels") != std::string::npos)
      return std::stoi(entry.path().filename().string());
  }
  return -1;
}

TEST(TexelFile, ReturnsWhatWasAdded) {
  TexelFile file(0);
  for (const auto& [width, height] : {std::pair(1, 1), {64, 64}, {65, 33}, {7, 300}, {200, 1}}) {
    const size_t count = size_t(width) * size_t(height);
    const std::vector<Texel8> bytes = texels8(count);
    const std::vector<vec4> floats = texelsFloat(count);
    const int a = file.add(width, height, bytes), b = file.add(width, height, floats);
    EXPECT_TRUE(file.has8Bits(a));
    EXPECT_FALSE(file.has8Bits(b));
    for (size_t i = 0; i < count; ++i) {
      const int x = int(i) % width, y = int(i) / width;
      ASSERT_EQ(file.texel8(a, x, y), bytes[i]) << x << " " << y;
      ASSERT_EQ(file.texelFloat(b, x, y), floats[i]) << x << " " << y;
    }
  }
  file.check();
}

// The cache holds a sixth of the texels.
TEST(SlowTexelFile, ThreadsReadTheSameWhileTilesAreDiscarded) {
  constexpr int kWidth = 2048, kHeight = 2048, kImages = 4;
  TexelFile file(0);
  for (uint64_t i = 0; i < kImages; ++i)
    file.add(kWidth, kHeight, texels8(size_t(kWidth) * kHeight, i << 32));
  EXPECT_GT(file.byteCount(), 6 * file.cacheBytes());
  std::atomic<int> wrong = 0;
  parallelFor(0, 64, [&](int task) {
    for (uint64_t i = 0; i < 4000; ++i) {
      const uint64_t random = hash(uint64_t(task) << 32 | i);
      const int image = int(random % kImages), x = int(random >> 8) & (kWidth - 1),
                y = int(random >> 24) & (kHeight - 1);
      const uint64_t index = uint64_t(y) * kWidth + uint64_t(x);
      wrong += file.texel8(image, x, y) != texelAt((uint64_t(image) << 32) + index);
    }
  });
  EXPECT_EQ(wrong, 0);
  file.check();
}

TEST(TexelFile, HasNoNameInItsFolder) {
  const TemporaryFolder folder;
  const char* before = std::getenv("TMPDIR");
  const std::string old = before ? before : "";
  setenv("TMPDIR", (folder / "").c_str(), 1);
  {
    TexelFile file(0);
    file.add(2, 1, texels8(2));
    EXPECT_EQ(folder.files(), Words{});
  }
  setenv("TMPDIR", (folder / "none").c_str(), 1);
  EXPECT_THROW(TexelFile(0), std::exception);
  before ? setenv("TMPDIR", old.c_str(), 1) : unsetenv("TMPDIR");
}

TEST(TexelFile, AFailureToReadIsReported) {
  TexelFile file(0);
  const int image = file.add(64, 128, texels8(64 * 128));
  EXPECT_EQ(file.texel8(image, 1, 0), texelAt(1));
  ASSERT_EQ(ftruncate(openTexelFile(), 20000), 0);
  EXPECT_EQ(file.texel8(image, 1, 100), Texel8{});
  EXPECT_THROW(file.check(), RunError);
}

TEST(TexelFile, FilteringIsThatOfMemory) {
  constexpr int kWidth = 200, kHeight = 130;
  TexelGrid deep{kWidth, kHeight, {}, texelsFloat(kWidth * kHeight)};
  TexelGrid flat{kWidth, kHeight, texels8(kWidth * kHeight), {}};
  TexelFile file(0);
  for (const TexelGrid* grid : {&deep, &flat})
    for (const bool srgb : {false, true})
      for (const Filter filter : {Filter::Linear, Filter::Nearest})
        for (const bool weighted : {false, true}) {
          Texture memory{grid, Wrap::Repeat, Wrap::MirroredRepeat, filter, srgb, weighted, {}};
          memory.mipLevels =
              std::make_shared<std::vector<TexelGrid>>(makeMipLevels(*grid, srgb, weighted));
          std::vector<TexelGrid> levels = *memory.mipLevels;
          TexelGrid base = *grid;
          std::vector<TexelGrid*> all{&base};
          for (TexelGrid& level : levels) all.push_back(&level);
          for (TexelGrid* g : all) {
            g->fileImage = grid == &deep ? file.add(g->width, g->height, g->texelsFloat)
                                         : file.add(g->width, g->height, g->texels8);
            g->file = &file;
            g->texels8.clear();
            g->texelsFloat.clear();
          }
          Texture inFile = memory;
          inFile.grid = &base;
          inFile.mipLevels = std::make_shared<std::vector<TexelGrid>>(levels);
          for (uint64_t i = 0; i < 300; ++i) {
            const uint64_t r = hash(i);
            const vec2 uv(float(r & 0xffff) / 20000 - 1, float(r >> 16 & 0xffff) / 20000 - 1);
            const float area = std::exp2(float(r >> 32 & 0xff) / 16);
            ASSERT_EQ(memory.lookup(uv), inFile.lookup(uv));
            ASSERT_EQ(memory.lookup(uv, area), inFile.lookup(uv, area));
          }
        }
}

// Quads side by side, each with a texture of its own.
std::string writeTexturedModel(GltfWriter& w, int count, int side) {
  const int uv = w.vec2s({0, 0, 1, 0, 0, 1});
  for (int i = 0; i < count; ++i) {
    std::vector<uint8_t> rgb(size_t(side) * size_t(side) * 3);
    for (size_t k = 0; k < rgb.size(); ++k) rgb[k] = uint8_t(k / 97 * size_t(i + 3) + k % 3 * 40);
    const std::string name = "texels" + std::to_string(i) + ".png";
    w.write(name, encodePng(side, side, 3, rgb));
    w.add("images", {{"uri", name}});
    w.add("textures", {{"source", i}});
    w.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    addTriangle(w, {{"material", i}, {"attributes", {{"TEXCOORD_0", uv}}}},
                {{"translation", {i, 0, 0.1 * i}}});
  }
  return w.save();
}

struct Outcome {
  std::vector<float> texels;
  nlohmann::json statistics;
};

Outcome run(const std::string& model, const Words& more) {
  const TemporaryFolder folder;
  Words words{"render",    model, "--probe", kProbe,           "--size",  "64x48",
              "--samples", "4",   "-o",      folder / "a.pfm", "--stats", folder / "a.json",
              "--quiet"};
  words.insert(words.end(), more.begin(), more.end());
  const CommandResult result = runCommand(words);
  EXPECT_EQ(result.status, 0) << result.error;
  if (result.status != 0) return {};
  return {readImage(folder / "a.pfm").texels, jsonOfFile(folder / "a.json")};
}

TEST(SlowTexelFile, ImagesHaveTheSameBitsAndMemoryIsBounded) {
  GltfWriter w;
  const std::string model = writeTexturedModel(w, 8, 2048);  // 179 MB with mip levels
  const Outcome memory = run(model, {});
  for (const char* threads : {"1", "3"}) {
    const Outcome file = run(model, {"--texture-memory", "0.02", "--threads", threads});
    EXPECT_EQ(file.texels, memory.texels) << threads;
    EXPECT_LT(file.statistics["texture_bytes"], 100000) << threads;
    EXPECT_GT(file.statistics["texture_file_bytes"], 170e6) << threads;
    if (kIsInstrumented) continue;
    // An image while it is decoded, with its levels and its file, is 40 MB.
    EXPECT_LT(file.statistics["peak_memory_bytes"].get<double>(),
              memory.statistics["peak_memory_bytes"].get<double>() - 179e6 + 70e6)
        << threads;
  }
  const Outcome fits = run(model, {"--texture-memory", "0.2"});
  EXPECT_EQ(fits.texels, memory.texels);
  EXPECT_EQ(fits.statistics["texture_file_bytes"], 0);
}

TEST(SlowTexelFile, RealModelsHaveTheSameBits) {
  for (const char* name : {"gltf/DamagedHelmet/glTF-Binary/DamagedHelmet.glb",
                           "gltf/WaterBottle/glTF/WaterBottle.gltf",
                           "gltf/AlphaBlendModeTest/glTF/AlphaBlendModeTest.gltf"}) {
    const auto model = sharedData(name);
    if (!model) continue;
    const Outcome memory = run(*model, {}), file = run(*model, {"--texture-memory", "1e-6"});
    EXPECT_EQ(file.texels, memory.texels) << name;
    EXPECT_GT(file.statistics["texture_file_bytes"], 1000000) << name;
  }
}

TEST(TexelFile, AFullDiskIsOneLine) {
  GltfWriter w;
  const std::string model = writeTexturedModel(w, 1, 512);
  const CommandResult result =
      runExecutable({"render", model, "--probe", kProbe, "--size", "8x8", "--texture-memory",
                     "1e-6", "-o", (w.folder() / "a.pfm").string(), "--quiet"},
                    "", SIGINT, {.fileSize = 500000});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  EXPECT_NE(result.error.find("temporary file for textures cannot be written"), std::string::npos)
      << result.error;
}

TEST(TexelFile, AFailureToReadEndsTheRender) {
  GltfWriter w;
  Settings given;
  given.set("texture-memory", 1e-6);
  given.set("probe.file", kProbe);
  given.set("render.size", ImageSize{200, 200});
  given.set("render.samples", uint64_t(1));
  RenderDescription description = planRender(openScene(writeTexturedModel(w, 1, 512)), given);
  const LoadedScene loaded = loadScene(description);
  ASSERT_EQ(ftruncate(openTexelFile(), 0), 0);
  try {
    renderLoaded(loaded);
    ADD_FAILURE() << "the texels are lost";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be read"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace chromeball::texel_file_test
