// SPDX-License-Identifier: Apache-2.0
// Interrupted runs and runs without disk space, memory or permission: a one-line message, the
// documented exit status, and no partially written file.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "base/file.h"
#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::starved_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A model of one triangle and a constant probe.
class Starved : public testing::Test {
 protected:
  void SetUp() override {
    addTriangle(writer_);
    model_ = writer_.save();
    probe_ = (writer_.folder() / "probe.exr").string();
    writeImage(probe_, constantProbe({8, 4}, Rgb(1)));
  }

  Words words(const std::string& output, const Words& more = {}) const {
    Words all{"render", model_, "--probe", probe_, "-o", output};
    all.insert(all.end(), more.begin(), more.end());
    const auto isGiven = [&](const char* option) {
      return std::find(more.begin(), more.end(), option) != more.end();
    };
    if (!isGiven("--size")) all.insert(all.end(), {"--size", "64x64"});
    if (!isGiven("--samples")) all.insert(all.end(), {"--samples", "1"});
    if (!isGiven("--progress")) all.push_back("--quiet");
    return all;
  }

  // Expects exit status 1 (a failure at run time) and a one-line message that contains `reason`.
  static void expectFailed(const CommandResult& result, const std::string& reason) {
    EXPECT_EQ(result.status, 1) << result.error;
    EXPECT_TRUE(result.error.starts_with("chromeball: ")) << result.error;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
    EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
  }

  GltfWriter writer_;
  std::string model_, probe_;
};

using SlowStarved = Starved;

TEST_F(SlowStarved, AFileSizeLimitLeavesTheOldFile) {
  const TemporaryFolder out;
  for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"}) {
    std::ofstream(out / name) << "old";
    const CommandLimits limits{.fileSize = 2000};
    expectFailed(runExecutable(words(out / name, {"--size", "200x200"}), "", SIGINT, limits), name);
    EXPECT_EQ(fileContents(out / name), "old") << name;
  }
  EXPECT_EQ(out.files(), (Words{"a.exr", "a.hdr", "a.pfm", "a.png"}));
}

TEST_F(SlowStarved, AFullDiskLeavesTheOldFile) {
  const TemporaryFolder folder;
  const std::string disk = folder / "disk";
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=8k") != 0)
    GTEST_SKIP() << "cannot mount a small file system (needs root)";
  for (const char* name : {"a.exr", "a.png", "a.hdr", "a.pfm"}) {
    const std::string path = disk + "/" + name;
    std::ofstream(path) << "old";
    expectFailed(runCommand(words(path, {"--size", "400x400"})), name);
    EXPECT_EQ(fileContents(path), "old") << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(disk), {}), 1) << name;
    fs::remove(path);
  }
  umount(disk.c_str());
}

TEST_F(SlowStarved, UnwritablePathsAreReportedBeforeRendering) {
  const TemporaryFolder out;
  fs::create_directory(out / "folder.exr");
  expectError(words(out / "folder.exr"), "is a folder");
  expectError(words(out / "none/a.exr"), "no folder");
  expectError(words(out / "a.exr", {"--stats", out / "none/a.json"}), "no folder");
  expectFailed(runCommand(words("/proc/a.exr")), "/proc/a.exr: cannot be written: ");
  EXPECT_EQ(out.files(), Words{"folder.exr"});
}

// The memory that a map of the size takes is known before it is made.
TEST_F(SlowStarved, MapsBeyondTheMemoryAreRefusedWithTheirAmount) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const TemporaryFolder out;
  const CommandLimits limits{.memory = size_t(1) << 30};
  const std::string map = out / "map.exr", size = "16384x8192";
  const auto refuse = [&](const Words& arguments) {
    const CommandResult result = expectError(arguments, map + ": ", limits);
    EXPECT_NE(result.error.find(" GB of memory in all; 0.859 GB are allowed"), std::string::npos)
        << result.error;
  };
  refuse({"probe", "irradiance", probe_, map, "--size", size});
  refuse({"probe", "irradiance", probe_, map, "--size", size, "--method", "sh"});
  refuse({"probe", "convert", probe_, map, "--to", "lat-long", "--size", size});
  refuse({"probe", "convolve", probe_, map, "--kernel", "phong:10", "--size", size});
  refuse({"probe", "synth", "constant", map, "--size", size});
  EXPECT_EQ(out.files(), Words{});
  EXPECT_EQ(
      runExecutable({"probe", "irradiance", probe_, map, "--size", "64x32"}, "", SIGINT, limits)
          .status,
      0);
}

TEST_F(SlowStarved, FoldersAndFilesWithoutPermission) {
  const TemporaryFolder out;
  const CommandLimits limits{.permissions = true};
  const auto run = [&](const Words& arguments) {
    return runExecutable(arguments, "", SIGINT, limits);
  };
  std::ofstream(out / "a.exr") << "old";
  fs::permissions(out / "", fs::perms::owner_read | fs::perms::owner_exec);
  expectFailed(run(words(out / "a.exr")), "Permission denied");
  expectFailed(run(words(out / "b.exr", {"--stats", out / "b.json"})), "Permission denied");
  EXPECT_EQ(fileContents(out / "a.exr"), "old");
  EXPECT_EQ(out.files(), Words{"a.exr"});
  fs::permissions(out / "", fs::perms::owner_all);
  fs::permissions(probe_, fs::perms::none);
  expectError(words(out / "a.exr"), "Permission denied", limits);
  fs::permissions(probe_, fs::perms::owner_all);
}

TEST_F(SlowStarved, SigintAndSigtermSaveTheImageSoFar) {
  for (int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder out;
    const Words all =
        words(out / "a.exr", {"--samples", "100000000", "--time", "60", "--progress", "--size",
                              "16x16", "--stats", out / "a.json", "--aov", "samples"});
    const CommandResult result = runExecutable(all, " samples", signal);  // a pass is done
    EXPECT_EQ(result.status, 130) << result.error;
    EXPECT_EQ(out.files(), (Words{"a.exr", "a.json"}));
    const auto stats = jsonOfFile(out / "a.json");
    EXPECT_EQ(stats["interrupted"], true);
    // `samples_per_pixel` counts complete passes; the layer `samples` has the count of each pixel.
    const Image samples = *findLayer(readImageFile(out / "a.exr"), "samples");
    EXPECT_GE(*std::min_element(samples.texels.begin(), samples.texels.end()),
              stats["samples_per_pixel"]);
    EXPECT_GT(stats["samples_per_pixel"], 0);
  }
}

// An image with missing pixels never replaces a complete one.
TEST_F(SlowStarved, AnInterruptInTheFirstPassLeavesTheOldFile) {
  const TemporaryFolder out;
  std::ofstream(out / "a.exr") << "old";
  const CommandResult result = runExecutable(
      words(out / "a.exr", {"--samples", "100000000", "--size", "4000x3000", "--progress"}), "%");
  EXPECT_EQ(result.status, 130) << result.error;
  EXPECT_EQ(fileContents(out / "a.exr"), "old");
  EXPECT_EQ(out.files(), (Words{"a.exr", "a.partial.exr"}));
  EXPECT_NE(result.error.find("a.partial.exr"), std::string::npos) << result.error;
}

// Nor an input, the checkpoint or another output, whose name it would have; nor does a lock.
TEST_F(SlowStarved, NoInputHasANameOfWhatARenderMayWrite) {
  const TemporaryFolder out;
  std::filesystem::copy_file(std::string(kSourceDir) + "/probes/dusk.exr", out / "a.partial.exr");
  std::filesystem::copy_file(std::string(kSourceDir) + "/probes/dusk.exr", out / "c.exr.lock");
  const std::string probe = out / "a.partial.exr";
  expectError({"render", std::string(kSourceDir) + "/scenes/models/pillars.gltf", "--probe", probe,
               "--size", "4x4", "-o", out / "a.exr"},
              "would overwrite the input");
  expectError(words(out / "a.exr", {"--checkpoint", out / "a.partial.exr"}), "overwrite");
  expectError(words(out / "a.exr", {"-o", out / "a.partial.exr"}), "overwrite");
  expectError(words(out / "b.exr", {"--checkpoint", out / "c.exr"}), "has contents");
  EXPECT_EQ(fileContents(out / "a.partial.exr"), fileContents(out / "c.exr.lock"));
}

TEST_F(SlowStarved, AKillDuringTheRenderLeavesTheOldFile) {
  const TemporaryFolder out;
  std::ofstream(out / "a.exr") << "old";
  const CommandResult result =
      runExecutable(words(out / "a.exr", {"--samples", "100000000", "--progress"}), "%", SIGKILL);
  EXPECT_EQ(result.status, -SIGKILL) << result.error;
  EXPECT_EQ(fileContents(out / "a.exr"), "old");
  EXPECT_EQ(out.files(), Words{"a.exr"});
}

// SIGKILL between the first byte of the new file and its rename.
TEST_F(SlowStarved, AKillDuringTheWriteLeavesTheOldFile) {
  const TemporaryFolder out;
  const std::string path = out / "a.pfm";
  std::ofstream(path) << "old";
  for (int attempt = 0; attempt < 3; ++attempt) {
    const pid_t child = fork();
    if (child == 0) {
      const AtomicFile file(path);
      std::ofstream stream(file.temporary());
      stream << "half of the new o" << std::flush;
      raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(fileContents(path), "old");
  }
  // The next run removes leftovers.
  EXPECT_EQ(runCommand(words(path)).status, 0);
  EXPECT_EQ(out.files(), Words{"a.pfm"});
  EXPECT_EQ(readImage(path).width, 64);
}

TEST_F(SlowStarved, TooLargeImagesAreRejectedBeforeAllocation) {
  const TemporaryFolder out;
  expectError(words(out / "a.exr", {"--size", "12000x12000", "--memory", "4"}),
              "12000x12000 takes 42 GB");
  expectError(words(out / "a.exr", {"--size", "16384x16384"}), "16384 x 16384 texels");
  expectError(words(out / "a.exr", {"--size", "100x100", "--memory", "0"}), "above 0");
  EXPECT_EQ(runCommand(words(out / "a.exr", {"--size", "1x1"})).status, 0);
}

TEST_F(SlowStarved, OutOfMemoryIsOneLine) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const TemporaryFolder out;
  const CommandLimits limits{.memory = size_t(1) << 30};
  const CommandResult result = runExecutable(
      words(out / "a.exr", {"--size", "3000x3000", "--memory", "1000"}), "", SIGINT, limits);
  expectFailed(result, "out of memory");
  EXPECT_EQ(out.files(), Words{});
}

}  // namespace
}  // namespace chromeball::starved_test
