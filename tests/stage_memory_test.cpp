// SPDX-License-Identifier: Apache-2.0
// chromeball basis and relight with stages that exceed --memory.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "probe/synth.h"
#include "run_command.h"
#include "session/memory_estimate.h"
#include "small_model.h"
#include "whole_stage.h"

namespace chromeball::stage_memory_test {
namespace {

using Words = std::vector<std::string>;

// The peak that the system states for a process, in bytes; 0 once it has ended.
double peakOf(pid_t process) {
  std::ifstream status("/proc/" + std::to_string(process) + "/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

// The peak of the executable's memory; NaN if it fails. After fork() alone a process would share
// the memory of this one.
double measuredPeak(const Words& words) {
  std::vector<char*> argv{const_cast<char*>(kCommand)};
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(const_cast<char*>("--quiet"));
  argv.push_back(nullptr);
  int started[2];
  if (pipe2(started, O_CLOEXEC) != 0) return NAN;
  const pid_t child = fork();
  if (child == 0) {
    execv(argv[0], argv.data());
    _exit(127);
  }
  close(started[1]);
  char end;
  while (read(started[0], &end, 1) < 0) {
  }  // until execv() closes it
  close(started[0]);
  double peak = 0;
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    peak = std::max(peak, peakOf(child));
    usleep(2000);
  }
  return status == 0 ? peak : NAN;
}

class SlowStageMemory : public testing::Test {
 protected:
  SlowStageMemory() {
    writeSmallModel(folder_ / "m.gltf");
    writeImage(folder_ / "p.exr", gradientProbe({32, 16}, Rgb(1, 2, 3), {0.3, 0.6, 0.6}));
  }

  Words basis(const std::string& size, const std::string& directions, const std::string& out,
              double memory, const std::string& samples = "1") const {
    const std::string model = folder_ / "m.gltf", path = folder_ / out;
    return {"basis",
            model,
            "--size",
            size,
            "--samples",
            samples,
            "--directions",
            directions,
            "-o",
            path,
            "--half",
            "--memory",
            fmt::format("{}", memory)};
  }
  Words relight(const std::string& stage, const std::string& out, double memory,
                const Words& more = {}) const {
    Words all{"relight", folder_ / stage, "--probe",  folder_ / "p.exr",
              "-o",      folder_ / out,   "--memory", fmt::format("{}", memory)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  // The memory, in GB, for which the stages of this test are rendered in bands of `rows` rows.
  static double memoryFor(const std::string& directions, int width, double rows) {
    const DirectionBasis basis(directions, "test");
    return 1e-9 * (kProcessBytes + 1e6 + StageWriter::bufferBytes(basis, width) +
                   rows * (width * elementBytes(basis)));
  }

  TemporaryFolder folder_;
};

TEST_F(SlowStageMemory, BandsGiveTheSameStageAndTheSamePictures) {
  const std::string directions = "lat-long:32x32";
  const CommandResult whole = runCommand(basis("64x80", directions, "whole.exr", 100));
  ASSERT_EQ(whole.status, 0) << whole.error;
  EXPECT_EQ(whole.out.find("bands"), std::string::npos) << whole.out;
  const CommandResult bands =
      runCommand(basis("64x80", directions, "bands.exr", memoryFor(directions, 64, 40)));
  ASSERT_EQ(bands.status, 0) << bands.error;
  EXPECT_NE(bands.out.find(", in 3 bands in "), std::string::npos) << bands.out;
  const LightStage a = readStage(folder_ / "whole.exr"), b = readStage(folder_ / "bands.exr");
  EXPECT_EQ(a.elements.texels, b.elements.texels);
  EXPECT_GT(*std::ranges::max_element(a.elements.texels), 0);

  for (const Words& more : {Words{}, Words{"--domain", "dct"},
                            Words{"--domain", "dct", "--keep", "10%", "--keep-light", "30"}}) {
    const auto picture = [&](const std::string& out, double memory) {
      const CommandResult result = runCommand(relight("bands.exr", out, memory, more));
      EXPECT_EQ(result.status, 0) << result.error;
      return std::pair(readImage(folder_ / out).texels, result.out.substr(result.out.find(" s")));
    };
    const StageReader file(folder_ / "bands.exr");
    const double some = 1e-9 * (kProcessBytes + 7e7 + file.bufferBytes() + 20 * file.rowBytes());
    const auto [pixels, text] = picture("a.exr", 100);
    const auto [samePixels, sameText] = picture("a.exr", some);
    EXPECT_EQ(pixels, samePixels);
    EXPECT_EQ(text, sameText);
  }
}

TEST_F(SlowStageMemory, RefusesWhatDoesNotFitInBands) {
  const std::string directions = "lat-long:32x32";
  const CommandResult little =
      expectError(basis("64x80", directions, "s.exr", memoryFor(directions, 64, 12)),
                  "--directions: 1024 elements of 16 rows of 64 pixels, the least at a time, take");
  EXPECT_NE(little.error.find("--memory"), std::string::npos) << little.error;
  expectError(basis("9000x9000", "lat-long:32x16", "s.exr", 1000),
              "--directions: 9000 x 9000 pixels with 512 elements are");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.exr"));
  ASSERT_EQ(runCommand(basis("64x80", directions, "s.exr", 100)).status, 0);
  expectError(relight("s.exr", "o.exr", 0.03), "s.exr: a row of 64 pixels with 1024 elements");
  expectError(
      {"relight", folder_ / "s.exr", "--probe", folder_ / "p.exr", "--preview", "--memory", "0.08"},
      "--preview: 1024 elements of 64 x 80 pixels take");
  for (const char* memory : {"0", "-1", "nan", "inf"})
    expectError({"relight", folder_ / "s.exr", "--probe", folder_ / "p.exr", "-o",
                 folder_ / "o.exr", "--memory", memory},
                "--memory");
}

TEST_F(SlowStageMemory, AnInterruptLeavesTheOldFile) {
  std::ofstream(folder_ / "s.exr") << "old";
  for (const int signal : {SIGINT, SIGTERM}) {
    Words words =
        basis("64x80", "lat-long:32x32", "s.exr", memoryFor("lat-long:32x32", 64, 40), "1000000");
    words.push_back("--progress");
    const CommandResult result = runExecutable(words, "%", signal);
    EXPECT_EQ(result.status, 130) << result.error;
    EXPECT_NE(result.error.find("s.exr is not written"), std::string::npos) << result.error;
    EXPECT_EQ(fileContents(folder_ / "s.exr"), "old");
    EXPECT_EQ(folder_.files(), (Words{"m.gltf", "p.exr", "s.exr"}));
  }
}

TEST_F(SlowStageMemory, AFullDiskLeavesTheOldFile) {
  std::ofstream(folder_ / "s.exr") << "old";
  const CommandResult result =
      runExecutable(basis("64x80", "lat-long:32x32", "s.exr", memoryFor("lat-long:32x32", 64, 40)),
                    "", SIGINT, {.fileSize = 20'000});
  EXPECT_EQ(result.status, 1) << result.error;
  EXPECT_EQ(fileContents(folder_ / "s.exr"), "old");
  EXPECT_EQ(folder_.files(), (Words{"m.gltf", "p.exr", "s.exr"}));
}

// 470 MB of elements.
TEST_F(SlowStageMemory, TheProcessStaysBelowTheLimit) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const std::string directions = "lat-long:64x32";
  const double memory = memoryFor(directions, 160, 36);
  const double peak = measuredPeak(basis("160x120", directions, "s.exr", memory));
  EXPECT_LT(peak, 1e9 * memory);
  EXPECT_GT(measuredPeak(basis("160x120", directions, "whole.exr", 100)), 1.5 * peak);
  const StageReader file(folder_ / "s.exr");
  const double some = 1e-9 * (kProcessBytes + 7e7 + file.bufferBytes() + 24 * file.rowBytes());
  for (const Words& more : {Words{}, Words{"--domain", "dct", "--keep", "10%"}}) {
    const double bands = measuredPeak(relight("s.exr", "o.exr", some, more));
    EXPECT_LT(bands, 1e9 * some);
    EXPECT_GT(measuredPeak(relight("s.exr", "o.exr", 100, more)), 1.5 * bands);
  }
}

}  // namespace
}  // namespace chromeball::stage_memory_test
