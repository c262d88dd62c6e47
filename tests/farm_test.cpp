// SPDX-License-Identifier: Apache-2.0
// tools/scripts/farm_slurm.sh on a real Slurm cluster: $SLURM_CONF, such as
// tools/scripts/one_machine_slurm.sh starts; skipped without one.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>

#include "image/io/read_image.h"
#include "run_command.h"

namespace chromeball::farm_test {
namespace {

int shell(const std::string& line) {
  return std::system(("{ " + line + "; } > /dev/null 2>&1").c_str());
}

// Asks three times: a busy machine may answer too late.
bool hasCluster() {
  return shell(
             "for i in 1 2 3; do sinfo -h -o %T | grep -E 'idle|mix|alloc' && exit; done; false") ==
         0;
}

constexpr const char* kNoCluster = "no Slurm cluster; see tools/scripts/one_machine_slurm.sh";

TEST(Farm, MergesShardsOneOfWhichWasKilled) {
  if (!hasCluster()) GTEST_SKIP() << kNoCluster;
  const TemporaryFolder folder;
  const std::string source = kSourceDir, merged = folder / "merged.exr", log = folder / "log";
  const std::string options =
      " --size 96x64 --samples 4000 --adaptive off --guide off --checkpoint-every 0.2";
  ASSERT_EQ(
      shell("CHROMEBALL=" + std::string(kCommand) + " " + source + "/tools/scripts/farm_slurm.sh " +
            source + "/scenes/demo.toml --shards 4 -o " + merged + " --" + options),
      0);
  bool killed = false;
  for (int tenths = 0; tenths < 2400 && !std::filesystem::exists(merged); ++tenths) {
    if (!killed && std::filesystem::exists(folder / "merged.parts/task-1.checkpoint.exr"))
      killed =
          shell("pkill -9 -f 'shard[ ]2/4 .*" + merged.substr(0, merged.size() - 4) + "'") == 0;
    usleep(100'000);
  }
  ASSERT_TRUE(std::filesystem::exists(merged));
  EXPECT_TRUE(killed);
  const std::string whole = folder / "whole.exr";
  ASSERT_EQ(shell(std::string(kCommand) + " render " + source + "/scenes/demo.toml" +
                  " --size 96x64 --samples 4000 --adaptive off --guide off -o " + whole),
            0);
  const Image a = readImage(merged), b = readImage(whole);
  ASSERT_EQ(a.texels.size(), b.texels.size());
  for (size_t i = 0; i < a.texels.size(); ++i)
    ASSERT_NEAR(a.texels[i], b.texels[i], 1e-6f * std::max(1.0f, b.texels[i]));
}

TEST(Farm, RendersFrames) {
  if (!hasCluster()) GTEST_SKIP() << kNoCluster;
  const TemporaryFolder folder;
  const std::string source = kSourceDir, demo = source + "/scenes/demo.toml";
  const std::string options = " --size 48x32 --samples 16 --orbit 360 -o ";
  ASSERT_EQ(shell("CHROMEBALL=" + std::string(kCommand) + " " + source +
                  "/tools/scripts/farm_slurm.sh " + demo + " --frames 2:6:2 -o " +
                  folder / "farm.##.exr -- --size 48x32 --samples 16 --orbit 360"),
            0);
  const auto frame = [&](const std::string& name, int number) {
    return folder / fmt::format("{}.{:02}.exr", name, number);
  };
  for (int tenths = 0; tenths < 1200; ++tenths) {
    if (std::filesystem::exists(frame("farm", 2)) && std::filesystem::exists(frame("farm", 4)) &&
        std::filesystem::exists(frame("farm", 6)))
      break;
    usleep(100'000);
  }
  ASSERT_EQ(shell(std::string(kCommand) + " render " + demo + " --frames 2:6:2" + options +
                  folder / "own.##.exr"),
            0);
  for (const int number : {2, 4, 6})
    EXPECT_EQ(readImage(frame("farm", number)).texels, readImage(frame("own", number)).texels);
}

TEST(Farm, RendersShardsOfFrames) {
  if (!hasCluster()) GTEST_SKIP() << kNoCluster;
  const TemporaryFolder folder;
  const std::string source = kSourceDir, demo = source + "/scenes/demo.toml";
  const std::string options = " --size 48x32 --samples 16 --adaptive off --guide off --orbit 360";
  ASSERT_EQ(shell("CHROMEBALL=" + std::string(kCommand) + " " + source +
                  "/tools/scripts/farm_slurm.sh " + demo + " --frames 9:10 --shards 2 -o " +
                  folder / "farm.##.exr -o " + folder / "farm.##.png --" + options),
            0);
  const auto frame = [&](const std::string& name) { return folder / name; };
  for (int tenths = 0; tenths < 1200; ++tenths) {
    if (std::filesystem::exists(frame("farm.09.png")) &&
        std::filesystem::exists(frame("farm.10.png")))
      break;
    usleep(100'000);
  }
  ASSERT_EQ(shell(std::string(kCommand) + " render " + demo + " --frames 9:10" + options + " -o " +
                  folder / "own.##.exr"),
            0);
  for (const std::string number : {"09", "10"}) {
    const Image a = readImage(frame("farm." + number + ".exr"));
    const Image b = readImage(frame("own." + number + ".exr"));
    ASSERT_EQ(a.texels.size(), b.texels.size());
    for (size_t i = 0; i < a.texels.size(); ++i)
      ASSERT_NEAR(a.texels[i], b.texels[i], 1e-6f * std::max(1.0f, b.texels[i]));
  }
}

}  // namespace
}  // namespace chromeball::farm_test
