// SPDX-License-Identifier: Apache-2.0
// chromeball doctor, and the limits of memory that it tells of.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/json.h"
#include "base/memory.h"
#include "instrumented.h"
#include "json_file.h"
#include "run_command.h"

namespace chromeball::command_doctor_test {
namespace {

TEST(SlowCommandDoctor, TellsOfThisMachine) {
  const CommandResult result = runExecutable({"doctor", "--json"});
  ASSERT_EQ(result.status, 0) << result.error;
  const nlohmann::json found = parseJson(result.out);
  for (const char* library : {"chromeball", "embree", "openexr", "openimageio", "tbb"})
    EXPECT_NE(found["versions"][library].get<std::string>().find('.'), std::string::npos)
        << library;
  const int lanes = found["embree_lanes"];
  EXPECT_TRUE(lanes == 4 || lanes == 8 || lanes == 16);
  EXPECT_GE(found["threads"], 1);
  EXPECT_EQ(found["memory"]["for_renders"], memoryBudget());
  // Else this would not run.
  for (const auto& unit : found["vector_units"]) EXPECT_TRUE(unit["there"] || !unit["used"]);
  EXPECT_TRUE(found["missing"].empty());
  EXPECT_TRUE(runCommand({"doctor"}).out.ends_with("\nnothing is missing\n"));
}

TEST(SlowCommandDoctor, SaysWhatIsMissing) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const CommandResult result = runExecutable({"doctor"}, "", SIGINT, {.memory = size_t(1) << 30});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.out.find("address space 1.07 GB"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("nothing is missing"), std::string::npos);
  EXPECT_NE(result.error.find("memory: renders may use 0.86 GB, too little for large probes"),
            std::string::npos)
      << result.error;
}

TEST(ControlGroups, TheSmallestLimitCounts) {
  const TemporaryFolder folder;
  const std::filesystem::path root = folder / "groups";
  std::filesystem::create_directories(root / "farm/job");
  const auto limit = [&](const char* file, const char* text) {
    std::ofstream(root / file) << text << "\n";
  };
  EXPECT_EQ(controlGroupLimit(root, "farm/job"), INFINITY);
  limit("farm/job/memory.max", "max");
  EXPECT_EQ(controlGroupLimit(root, "farm/job"), INFINITY);
  limit("farm/memory.max", "3000000000");
  EXPECT_EQ(controlGroupLimit(root, "farm/job"), 3e9);
  limit("farm/job/memory.max", "2000000000");
  EXPECT_EQ(controlGroupLimit(root, "farm/job"), 2e9);
  limit("memory.limit_in_bytes", "9223372036854771712");  // version 1: none
  EXPECT_EQ(controlGroupLimit(root, ""), INFINITY);
  limit("memory.limit_in_bytes", "1000000000");
  EXPECT_EQ(controlGroupLimit(root, "farm/job"), 1e9);
  EXPECT_EQ(controlGroupLimit(root, "of/the/host"), 1e9);
}

}  // namespace
}  // namespace chromeball::command_doctor_test
