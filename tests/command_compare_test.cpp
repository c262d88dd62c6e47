// chromeball compare.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "image/read.h"
#include "image/write.h"
#include "probe/synth.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

// A triangle above a gradient, 16 x 16 pixels.
class SlowCommandCompare : public testing::Test {
 protected:
  SlowCommandCompare() {
    writeSmallModel(folder_ / "plate.gltf");
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6}));
  }

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"compare", folder_ / "plate.gltf",
                                 "--probe", folder_ / "probe.exr",
                                 "--size",  "16x16",
                                 "-o",      dir(),
                                 "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string dir() const { return folder_ / "report"; }
  json results() const { return json::parse(fileContents(dir() + "/results.json")); }
  std::map<fs::path, fs::file_time_type> renders() const {
    std::map<fs::path, fs::file_time_type> found;
    for (const auto& entry : fs::directory_iterator(dir() + "/renders"))
      found[entry.path()] = entry.last_write_time();
    return found;
  }

  TemporaryFolder folder_;
};

const std::vector<std::string> kSmall = {"--strategies",        "bsdf,importance,median-cut:4",
                                         "--samples",           "1,4",
                                         "--repeats",           "3",
                                         "--reference-samples", "64"};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST_F(SlowCommandCompare, writesEveryNumberAndContinues) {
  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  const json first = results();
  EXPECT_TRUE(first["complete"]);
  ASSERT_EQ(first["strategies"].size(), 3u);
  for (const json& strategy : first["strategies"]) {
    ASSERT_EQ(strategy["cells"].size(), 2u);
    EXPECT_EQ(strategy["unbiased"], strategy["name"] != "median-cut:4");
    for (const json& cell : strategy["cells"]) {
      EXPECT_GT(cell["relmse"]["mean"], 0);
      EXPECT_GT(cell["seconds"]["mean"], 0);
    }
  }
  EXPECT_EQ(first["same_picture"].size(), 1u) << "one pair of unbiased strategies";
  const std::string csv = fileContents(dir() + "/results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 2);
  EXPECT_EQ(first["baseline"], "bsdf");

  // The same command renders nothing again; another repeat renders only that.
  const auto before = renders();
  EXPECT_EQ(before.size(), 8u + 3 * 2 * 3);
  std::ofstream(dir() + "/notes.txt") << "mine";
  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  EXPECT_EQ(renders(), before);
  EXPECT_EQ(results()["strategies"], first["strategies"]);
  ASSERT_EQ(runCommand(command(with(kSmall, {"--repeats", "4"}))).status, 2) << "given twice";
  std::vector<std::string> more = kSmall;
  more[5] = "4";
  ASSERT_EQ(runCommand(command(more)).status, 0);
  EXPECT_EQ(renders().size(), before.size() + 3 * 2);
  for (const auto& [path, time] : before) EXPECT_EQ(renders()[path], time) << path;
  EXPECT_EQ(fileContents(dir() + "/notes.txt"), "mine");
}

TEST_F(SlowCommandCompare, stoppedRunKeepsWhatItHas) {
  const std::vector<std::string> endless = {
      "--strategies", "bsdf,importance",     "--samples", "1,4,100000",
      "--progress",   "--reference-samples", "64"};
  std::vector<std::string> arguments = command(endless);
  std::erase(arguments, "--quiet");
  // The largest cells take minutes; by the time the bar says a per cent, smaller ones are done.
  const CommandResult result = runCommand(arguments, "% ");
  EXPECT_EQ(result.status, 130) << result.error;
  EXPECT_NE(result.error.find("the same command goes on from there"), std::string::npos);
}

TEST_F(SlowCommandCompare, referenceFromAFileAndTimes) {
  const std::string reference = folder_ / "reference.exr";
  ASSERT_EQ(
      runCommand({"render", folder_ / "plate.gltf", "--probe", folder_ / "probe.exr", "--size",
                  "16x16", "--samples", "256", "-o", reference, "--aov", "variance", "--quiet"})
          .status,
      0);
  ASSERT_EQ(runCommand(command({"--strategies", "uniform", "--times", "0.1,0.2", "--repeats", "3",
                                "--reference", reference}))
                .status,
            0);
  const json all = results(), &cells = all["strategies"][0]["cells"];
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0]["budget"], "0.1s");
  EXPECT_GE(cells[0]["samples"], 1);
  for (const json& warning : all["warnings"])
    EXPECT_EQ(std::string(warning).find("taken for exact"), std::string::npos) << warning;
}

TEST_F(SlowCommandCompare, badInputIsRefused) {
  const auto refused = [&](const std::vector<std::string>& arguments, const char* reason) {
    expectRefused(command(arguments), reason);
  };
  refused({"--strategies", "importanse"}, "importance");
  refused({"--samples", "0"}, "--samples");
  refused({"--times", "-1"}, "--times");
  refused({"--repeats", "2"}, "--repeats");
  refused({"--baseline", "uniform", "--strategies", "bsdf"}, "--baseline");
  refused({"--reference-strategy", "median-cut"}, "biased");
  refused({"--reference-samples", "3"}, "--reference-samples");
  Image sunny = constantProbe({32, 16}, Rgb(0.1f));
  sunny.setRgb(9, 4, Rgb(1e4f));
  writeImage(folder_ / "sunny.exr", sunny);
  std::vector<std::string> underSun = command({"--reference-strategy", "suns"});
  underSun[3] = folder_ / "sunny.exr";
  expectRefused(underSun, "biased");
  writeImage(folder_ / "other.exr", Image(8, 8, 3));
  refused({"--reference", folder_ / "other.exr"}, "--size 8x8");
  EXPECT_FALSE(fs::exists(dir())) << "nothing is made before all is right";

  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  refused(with(kSmall, {"--seed", "1"}), "another folder");
  const fs::path stored = renders().begin()->first;
  const ImageFile file = readImageFile(stored);
  for (const Layer& spoilt : {Layer{"", "RGB", Image(8, 8, 3)}, Layer{"N", "XYZ", file.image}}) {
    writeImage(stored, OutputImage{{spoilt}, file.metadata});
    refused(kSmall, "is not the render that it was");
  }
  fs::resize_file(stored, fs::file_size(stored) / 2);
  refused(kSmall, stored.filename().c_str());
}

}  // namespace
}  // namespace chromeball
