// SPDX-License-Identifier: Apache-2.0
// Malicious and damaged files: malformed models, damaged images, and small files that claim to be
// large.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "json_file.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/framing.h"
#include "scene/gltf/load_gltf.h"
#include "shared_data.h"
#include "test_scene.h"

namespace chromeball::hostile_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const CommandLimits kGibibyte{.memory = kIsInstrumented ? 0 : size_t(1) << 30};

std::vector<fs::path> filesBelow(const fs::path& root, const std::set<std::string>& extensions) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// Expects a single line that is not truncated: all brackets and quotes are closed.
void expectCompleteLine(const std::string& message) {
  const auto count = [&](char c) { return std::count(message.begin(), message.end(), c); };
  EXPECT_EQ(count('\n'), 0) << message;
  EXPECT_EQ(count('('), count(')')) << message;
  EXPECT_EQ(count('"') % 2, 0) << message;
}

// The reason why the file is rejected, or "" if it renders without invalid samples. Exceptions
// other than InputError fail the test; a crash or a hang fails all of them.
std::string modelErrorMessage(const fs::path& path) {
  try {
    const Scene scene = loadGltf(path.string(), {}, nullptr);
    if (scene.instances.empty()) return "";
    const Probe probe(constantProbe({8, 4}, Rgb(1)));
    const RenderResult result =
        renderScene(scene, framingCamera(scene, 1), probe, "importance", smallRender(8, 8, 2, 4));
    EXPECT_EQ(result.invalid.total(), 0u) << path;
    return "";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
    expectCompleteLine(message);
    return message.substr(std::min(message.size(), path.string().size() + 2));
  }
}

std::string imageErrorMessage(const fs::path& path) {
  try {
    const ImageFile file = readImageFile(path);
    for (const std::string& layer : layerNames(file)) findLayer(file, layer);
    const LoadedProbe loaded = loadProbe(path, "auto", "");
    const Probe probe(loaded.latLong);
    EXPECT_TRUE(isFinite(probe.radiance({0, 1, 0}))) << path;
    return "";
  } catch (const InputError& error) {
    expectCompleteLine(error.what());
    return error.what();
  }
}

TEST(SlowHostile, MalformedModelsAreRejectedOrRendered) {
  const auto root = sharedData("bad");
  if (!root) GTEST_SKIP() << "no ../shared/data/bad";
  int rejected = 0, rendered = 0;
  for (const fs::path& path : filesBelow(*root, {".gltf", ".glb"}))
    ++(modelErrorMessage(path).empty() ? rendered : rejected);
  EXPECT_GT(rejected, 50);
  EXPECT_GT(rendered, 20);
}

// Models in which Khronos's validator finds no error must load.
TEST(SlowHostile, ValidModelsAreRead) {
  const auto root = sharedData("bad/gltf-validator/base");
  if (!root) GTEST_SKIP() << "no ../shared/data/bad/gltf-validator";
  // Only warnings for the validator: a URI scheme, a missing file, an accessor of unknown type.
  const std::set<std::string> kRejected = {"non_relative_uri.gltf", "min_version_valid.gltf",
                                           "unknown_type.gltf"};
  int valid = 0;
  for (const fs::path& path : filesBelow(*root, {".gltf", ".glb"})) {
    const fs::path report = path.string() + ".report.json";
    if (!fs::exists(report)) continue;
    const auto issues = jsonOfFile(report).at("issues");
    if (issues.at("numErrors") != 0) continue;
    const std::string errorMessage = modelErrorMessage(path);
    EXPECT_EQ(errorMessage.empty(), !kRejected.contains(path.filename()))
        << path << ": " << errorMessage;
    ++valid;
  }
  EXPECT_GT(valid, 30);
}

TEST(SlowHostile, DamagedImagesAreRejectedOrRead) {
  const auto root = sharedData("bad/images");
  if (!root) GTEST_SKIP() << "no ../shared/data/bad/images";
  int rejected = 0;
  for (const fs::path& path : filesBelow(*root, {".exr", ".png"})) {
    const bool isRejected = !imageErrorMessage(path).empty();
    rejected += isRejected;
    if (path.parent_path().filename() == "openexr-damaged") {
      EXPECT_TRUE(isRejected) << path;
    }
    if (path.parent_path().filename() == "openexr-values") {
      const bool isPartOfColor = path.filename() == "WideFloatRange.exr";  // a channel G alone
      EXPECT_EQ(isRejected, isPartOfColor) << path;
    }
  }
  EXPECT_GT(rejected, 60);
}

// The command prints one line and uses at most a gibibyte of memory.
TEST(SlowHostile, TheCommandRejectsInOneLine) {
  const auto root = sharedData("bad");
  if (!root) GTEST_SKIP() << "no ../shared/data/bad";
  const TemporaryFolder out;
  const std::string probe = out / "probe.hdr";
  writeImage(probe, constantProbe({8, 4}, Rgb(1)));
  for (const char* model : {"assimp/RecursiveNodes/RecursiveNodes.gltf",
                            "assimp/IndexOutOfRange/IndexOutOfRange.gltf", "tinygltf/issue-492.glb",
                            "asset-generator-negative/Mesh_NoPosition/Mesh_NoPosition_00.gltf",
                            "tinygltf/BoundsChecking/integer-out-of-bounds.gltf"})
    expectError({"render", (*root / model).string(), "--probe", probe, "-o", out / "a.exr"}, model,
                kGibibyte);
  for (const char* image : {"memory_DOS_2.1.exr", "oom_exr.exr", "heap_overflow_exr.exr"})
    expectError({"probe", "info", (*root / "images/openexr-damaged" / image).string()}, image,
                kGibibyte);
  for (const char* image : {"xs1n0g01.png", "x_unexpected_eof.png"})
    expectError({"image", "view", (*root / "images/png" / image).string(), out / "a.png"}, image,
                kGibibyte);
  EXPECT_EQ(out.files(), Words{"probe.hdr"});
}

// Headers that claim more texels than the file can hold are rejected before anything is allocated.
TEST(SlowHostile, SizeBombsAreRejectedByTheirHeaders) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  };
  const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 40000\n";
  expectError({"probe", "info", write("a.hdr", hdr + std::string(150, '\1'))},
              "40000 x 40000 texels", kGibibyte);
  const std::string pfm = "PF\n20000 8000\n-1\n";
  expectError({"probe", "info", write("a.pfm", pfm + std::string(100, '\1'))}, "20000 x 8000",
              kGibibyte);
  // A PNG with a header of 16000 x 8000 and data for two texels.
  std::string png(kPng.begin(), kPng.end());
  png.replace(16, 17,
              std::string("\x00\x00\x3e\x80\x00\x00\x1f\x40\x08\x02\x00\x00\x00", 13) +
                  std::string("\xb6\x3e\x64\x15", 4));
  expectError({"probe", "info", write("a.png", png)}, "too short for 16000 x 8000", kGibibyte);
  // The headers of a JPEG: 65500 x 65500, three components, one quantisation table.
  const std::string jpeg =
      std::string(
          "\xff\xd8\xff\xe0\x00\x10JFIF\x00\x01\x01\x00\x00\x01\x00\x01\x00\x00"
          "\xff\xdb\x00\x43\x00",
          25) +
      std::string(64, '\1') +
      std::string(
          "\xff\xc0\x00\x11\x08\xff\xdc\xff\xdc\x03\x01\x11\x00\x02\x11\x00\x03\x11\x00"
          "\xff\xda\x00\x0c\x03\x01\x00\x02\x11\x03\x11\x00\x3f\x00\xff\xd9",
          35);
  expectError({"probe", "info", write("a.jpg", jpeg)}, "65500 x 65500", kGibibyte);
  std::string truncated = jpeg;
  truncated.replace(jpeg.find("\xff\xdc"), 4, std::string("\4\0\4\0", 4));
  expectError({"probe", "info", write("a.jpg", truncated)}, "1024 x 1024 texels cannot fit into");

  GltfWriter model;
  model.write("bomb.jpg", {jpeg.begin(), jpeg.end()});
  model.add("images", {{"uri", "bomb.jpg"}});
  model.add("textures", {{"source", 0}});
  model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  addTriangle(model, {{"material", 0}});
  expectError({"render", model.save(), "-o", folder / "out.exr"},
              "bomb.jpg): damaged image: 65500 x 65500", kGibibyte);
}

// An EXR with `attributes` of name, type and content; `length` is the stated length of the last
// one.
std::string exr(const std::vector<std::array<std::string, 3>>& attributes,
                std::optional<uint32_t> length = {}) {
  const auto number = [](uint32_t n) { return std::string(reinterpret_cast<char*>(&n), 4); };
  std::string file("\x76\x2f\x31\x01\x02\0\0\0", 8);
  for (const auto& [name, type, content] : attributes) {
    const bool last = name == attributes.back()[0];
    file += name + '\0' + type + '\0' +
            number(last && length ? *length : uint32_t(content.size())) + content;
  }
  return file + '\0';
}

// Found by fuzzing: for a file of 367 bytes OpenEXR allocated 1.8 GB, the stated length of a
// string, before it checked the length of the file. It allocates its row buffers as early.
TEST(SlowHostile, ExrHeadersAreChecked) {
  const TemporaryFolder folder;
  const auto words = [](std::initializer_list<int32_t> numbers) {
    return std::string(reinterpret_cast<const char*>(numbers.begin()), 4 * numbers.size());
  };
  const auto expectHeaderError = [&](const std::string& bytes, const std::string& reason) {
    std::ofstream(folder / "a.exr", std::ios::binary) << bytes;
    expectError({"probe", "info", folder / "a.exr"}, reason, kGibibyte);
  };
  const std::string channel = std::string("R\0", 2) + words({1, 0, 1, 1}) + '\0';
  const std::array<std::string, 3> channels = {"channels", "chlist", channel};
  expectHeaderError(exr({channels, {"owner", "string", "I"}}, 0x6e000013),
                    "more bytes than the file");
  expectHeaderError(exr({channels, {"owner", "string", "I"}}, 0xffffffff),
                    "more bytes than the file");
  expectHeaderError(exr({channels, {"dataWindow", "box2i", words({0, 0, (1 << 27) - 1, 0})}}),
                    "134217728 texels per row");
  expectHeaderError(exr({channels, {"dataWindow", "box2i", words({INT32_MIN, 0, INT32_MAX, 0})}}),
                    "4294967296 x 1 texels");
  expectHeaderError(exr({channels, {"tiles", "tiledesc", words({60000, 60000}) + '\0'}}),
                    "60000 x 60000 texels");
  // Another attribute of its type is no channel list, nor a compression.
  std::string thousands;
  for (int i = 1000; i < 9000; ++i)
    thousands += "c" + std::to_string(i) + '\0' + words({1, 0, 1, 1});
  expectHeaderError(exr({{"channels", "chlist", thousands + '\0'},
                         {"dataWindow", "box2i", words({0, 0, 119999, 0})},
                         {"other", "chlist", channel}}),
                    "exceed the limit");
  // Read beyond its stated length, the channel list would hide the next attribute.
  const std::array<std::string, 3> endless = {"channels", "chlist", channel.substr(0, 18)};
  expectHeaderError(exr({endless, {"owner", "string", "I"}}), "a list of 18 bytes");
  expectHeaderError(exr({channels, {"lineOrder", "lineOrder", "too long"}}),
                    "lineOrder of 8 bytes");
  expectHeaderError(exr({channels, {"views", "stringvector", words({1 << 30})}}),
                    "a list of 4 bytes");
  expectHeaderError(exr({{std::string(300, 'n'), "string", ""}}), "does not end");
}

TEST(SlowHostile, OtherFormatsAreRejectedByTheirFirstBytes) {
  const TemporaryFolder folder;
  for (const std::string& bytes : {std::string("GIF89a\1\0\1\0", 10), std::string("BM\x46"),
                                   std::string("\0\0\1\0\1\0", 6), std::string("SIMPLE  =")}) {
    std::ofstream(folder / "a.exr", std::ios::binary) << bytes;
    expectError({"probe", "info", folder / "a.exr"}, "not an EXR", kGibibyte);
  }
}

}  // namespace
}  // namespace chromeball::hostile_test
