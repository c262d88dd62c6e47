// SPDX-License-Identifier: Apache-2.0
// The scripts behind tools/build.sh, tools/test.sh and tools/lint.sh, and
// tools/scripts/sanitize.sh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "regular_expression.h"
#include "run_command.h"

namespace scripts_test {
namespace {

// A script of tools/scripts, which reads `input`, in a folder of its own.
class SlowScripts : public testing::Test {
 protected:
  TemporaryFolder folder_;

  CommandResult shell(const std::string& line) const {
    const TemporaryFolder output;
    const int status = std::system(("cd '" + folder_ / "" + "' && { " + line + "; } > " +
                                    output / "out" + " 2> " + output / "error")
                                       .c_str());
    return commandResult(status, output / "out", output / "error");
  }
  CommandResult script(const std::string& line) const {
    return shell(std::string(kSourceDir) + "/tools/scripts/" + line);
  }
  void write(const std::string& path, const std::string& text) const {
    const std::filesystem::path file = folder_ / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
};

TEST_F(SlowScripts, ProgressShowsTheShareAndWhatIsWrong) {
  write("make",
        "-- Configuring done\n"
        "[  4%] Building CXX object a.cpp.o\n"
        "a.cpp:3:5: warning: unused variable\n"
        "    3 |   int a;\n"
        "[ 57%] Building CXX object b.cpp.o\n"
        "make[2]: *** [b.cpp.o] Error 1\n");
  const CommandResult make = script("progress.sh < make");
  EXPECT_EQ(make.out, "57 % built, 0:00 min\n");
  EXPECT_EQ(make.error,
            "a.cpp:3:5: warning: unused variable\n"
            "    3 |   int a;\n"
            "make[2]: *** [b.cpp.o] Error 1\n");

  // A line of output in two parts, and guesses of the time left.
  const CommandResult ninja = shell(
      "(echo '[1/8] Building CXX object a'; sleep 3; printf '[2/8] Build'; sleep 3;"
      " echo 'ing CXX object b'; echo FAILED: c) | CHROMEBALL_PROGRESS_EVERY=1 " +
      std::string(kSourceDir) + "/tools/scripts/progress.sh");
  EXPECT_NE(ninja.out.find("12 % built, 0:0"), std::string::npos) << ninja.out;
  EXPECT_NE(ninja.out.find("25 % built, 0:0"), std::string::npos) << ninja.out;
  EXPECT_NE(ninja.out.find("about 0:3"), std::string::npos)
      << ninja.out;  // six steps of six seconds
  EXPECT_EQ(ninja.error, "FAILED: c\n");
}

TEST_F(SlowScripts, SkippedTestsAreNamed) {
  write("log",
        "[ RUN      ] A.b\n"
        "tests/a.cpp:21: Skipped\n"
        "no cluster\n"
        "[  SKIPPED ] A.b (0 ms)\n"
        "[ RUN      ] A.c\n"
        "[       OK ] A.c (2 ms)\n"
        "[ RUN      ] All/A.d/0\n"
        "tests/a.cpp:30: Skipped\n"
        "\n"
        "[  SKIPPED ] All/A.d/0, where GetParam() = 3 (0 ms)\n"
        "[  PASSED  ] 1 test.\n"
        "[  SKIPPED ] 2 tests, listed below:\n"
        "[  SKIPPED ] A.b\n"
        "[  SKIPPED ] All/A.d/0, where GetParam() = 3\n");
  EXPECT_EQ(script("skipped_tests.sh log").out,
            "A.b: no cluster\n"
            "All/A.d/0: no reason given\n");
}

// A repository in which three tests pass under sanitizers, and one is skipped.
class SlowSanitize : public SlowScripts {
 protected:
  void SetUp() override {
    if (shell("git --version").status != 0) GTEST_SKIP() << "no Git";
    write("bin/cmake", "#!/bin/sh\n");
    write("tools/scripts/run_tests.sh",
          "#!/bin/sh\n"
          "printf '[ RUN      ] A.b\\na.cpp:1: Skipped\\nno disk\\n[  SKIPPED ] A.b\\n' > "
          "$1/tests-0.log\n"
          "[ ! -e race ] || cp race $1/reports/report.1\n"
          "echo '3 passed, 0 failed'\n");
    write("tests/sanitizers/passed.txt", "# Comment\n");
    write("build/thread/onetbb/libtbb.so.12", "");
    write(".gitignore", "build\nrace\n");
    for (const char* name : {"sanitize.sh", "skipped_tests.sh"})
      std::filesystem::copy(std::string(kSourceDir) + "/tools/scripts/" + name,
                            folder_ / "tools/scripts/");
    EXPECT_EQ(shell("chmod +x bin/cmake tools/scripts/*.sh; git init -q").status, 0);
    commit();
  }
  void commit() const {
    EXPECT_EQ(shell("git add -A && git -c user.name=a -c user.email=a@b commit -qm change").status,
              0);
  }
  CommandResult sanitize(const std::string& arguments) const {
    return shell("PATH=$PWD/bin:$PATH tools/scripts/sanitize.sh " + arguments);
  }
  // The record, with "N" for dates and commits.
  std::string recorded() const {
    const std::string text = fileContents(folder_ / "tests/sanitizers/passed.txt");
    return replaceMatches(text, "[0-9-]{10}|commit [0-9a-f]{12}", "N");
  }
};

TEST_F(SlowSanitize, RecordsWhenAllTestsPassed) {
  const std::string comment = "# Comment\n\n", all = "address, all tests: 3 passed, N, N\n",
                    out = "  left out: A.b: no disk\n",
                    some = "thread, --gtest_filter=-Slow*: 3 passed, N, N\n";
  EXPECT_EQ(sanitize("address").out, "3 passed, 0 failed\n3 passed, 0 failed\n");
  EXPECT_EQ(recorded(), comment + all + out);
  commit();
  EXPECT_EQ(sanitize("thread --gtest_filter='-Slow*'").status, 0);
  EXPECT_EQ(recorded(), comment + all + out + "\n" + some + out);
  EXPECT_EQ(sanitize("address").status, 0);
  EXPECT_EQ(recorded(), comment + some + out + "\n" + all + out);
  commit();
  const std::string status = sanitize("status").out;
  EXPECT_TRUE(wholeMatch(status,
                         "thread, --gtest_filter=-Slow\\*: 3 passed, .*, 1 commits ago\n"
                         "address, all tests: 3 passed, .*, 1 commits ago\n"))
      << status;
}

TEST_F(SlowSanitize, AReportOrAnUncommittedChangeIsNotRecorded) {
  write("race", "data race\n");
  const CommandResult reported = sanitize("address");
  EXPECT_EQ(reported.status, 1);
  EXPECT_EQ(reported.error, "data race\n");
  EXPECT_EQ(reported.out, "3 passed, 0 failed\n3 passed, 1 failed\n");
  std::filesystem::remove(folder_ / "race");
  write("tools/scripts/skipped_tests.sh", "#!/bin/sh\n");
  EXPECT_EQ(sanitize("address").status, 0);
  EXPECT_EQ(recorded(), "# Comment\n");
}

// render.cpp includes light.h through scene.h, and the unused math.h is included by nothing.
class SlowLintSelection : public SlowScripts {
 protected:
  void SetUp() override {
    if (shell("git --version").status != 0) GTEST_SKIP() << "no Git";
    write("renderer/probe/light.h", "");
    write("renderer/probe/light.cpp", "#include \"probe/light.h\"\n");
    write("renderer/probe/sky.cpp", "# include  \"probe/light.h\"  // the sun\n");
    write("renderer/scene/scene.h", "#include \"probe/light.h\"\n");
    write("renderer/scene/scene.cpp", "#include <vector>\n#include \"scene/scene.h\"\n");
    write("renderer/trace/ray.cpp", "#include \"probe/light.h\"\n");
    write("tools/command/options.h", "#include \"scene/scene.h\"\n");
    write("tools/command/render.cpp", "#include \"options.h\"\n");
    write("tools/command/other.cpp", "#include \"math.h\"\n");
    write("tests/light_test.cpp", "#include \"probe/light.h\"\n");
    EXPECT_EQ(shell("git init -q").status, 0);
    commit();
    linted();
  }
  void commit(const std::string& options = "") const {
    EXPECT_EQ(shell("git add -A && " + kCommit + options).status, 0);
  }
  // The current commit has passed.
  void linted() const { EXPECT_EQ(shell("git rev-parse HEAD > tools/linted_commit").status, 0); }
  std::string selection(const std::string& limit = "") const {
    const CommandResult result = script("lint_selection.sh " + limit);
    EXPECT_EQ(result.status, 0) << result.error;
    return result.out + result.error;
  }

  const std::string kCommit = "git -c user.name=a -c user.email=a@b commit -q -m change ";
};

TEST_F(SlowLintSelection, ChangedFilesAreCommittedOrNot) {
  EXPECT_EQ(selection(), "");
  write("renderer/trace/ray.cpp", "int ray;\n");
  commit();
  write("tools/command/other.cpp", "int other;\n");
  write("renderer/probe/new.cpp", "int fresh;\n");
  write("tests/light_test.cpp", "int test;\n");
  std::filesystem::remove(folder_ / "renderer/probe/sky.cpp");
  EXPECT_EQ(selection(),
            "renderer/probe/new.cpp\nrenderer/trace/ray.cpp\ntools/command/other.cpp\n");
}

TEST_F(SlowLintSelection, FilesThatIncludeAChangedHeaderFollowByNearness) {
  write("renderer/probe/light.h", "int light;\n");
  EXPECT_EQ(selection(),
            "renderer/probe/light.cpp\nrenderer/probe/sky.cpp\nrenderer/trace/ray.cpp\n"
            "renderer/scene/scene.cpp\ntools/command/render.cpp\n");
  EXPECT_EQ(
      selection("2"),
      "renderer/probe/light.cpp\nrenderer/probe/sky.cpp\n3 more files include a changed header\n");
  write("renderer/scene/scene.cpp", "#include \"scene/scene.h\"\nint scene;\n");  // has light.h too
  EXPECT_EQ(selection("1"), "renderer/scene/scene.cpp\n4 more files include a changed header\n");
  write("tools/command/options.h", "int options;\n");  // only render.cpp includes it
  EXPECT_EQ(selection("1"),
            "renderer/scene/scene.cpp\ntools/command/render.cpp\n3 more files include a changed "
            "header\n");
}

TEST_F(SlowLintSelection, OtherChecksSelectAllFiles) {
  write("tools/command/.clang-tidy", "Checks: '-*'\n");
  const std::string all = selection("1");
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 6) << all;
}

TEST_F(SlowLintSelection, TheLintedCommitIsNear) {
  EXPECT_EQ(shell("head=$(git symbolic-ref HEAD); for i in $(seq 100); do"
                  "  printf 'commit %s\\ncommitter a <a@b> 0 +0000\\ndata 0\\n' $head;"
                  "  [ $i -gt 1 ] || echo from $head^0; done | git fast-import --quiet")
                .status,
            0);
  EXPECT_EQ(selection(), "");
  commit("--allow-empty");
  const CommandResult far = script("lint_selection.sh");
  EXPECT_EQ(far.status, 1);
  EXPECT_NE(far.error.find("more than 100 commits back"), std::string::npos) << far.error;
  write("tools/linted_commit", std::string(40, '1') + "\n");
  const CommandResult unknown = script("lint_selection.sh");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_NE(unknown.error.find("not in the history"), std::string::npos) << unknown.error;

  const TemporaryFolder shallow;
  EXPECT_EQ(shell("git clone -q --depth 1 file://$PWD " + shallow / "clone").status, 0);
  const CommandResult cut = shell("cd " + shallow / "clone" + " && git -C " + folder_ / "" +
                                  " rev-parse HEAD~5 > tools/linted_commit && " +
                                  std::string(kSourceDir) + "/tools/scripts/lint_selection.sh");
  EXPECT_EQ(cut.status, 1);
  EXPECT_NE(cut.error.find("git fetch --unshallow"), std::string::npos) << cut.error;
}

// The part of docs/capture.md about real photographs.
TEST(SlowCaptureTutorial, WritesItsRecordIntoAnotherFolder) {
  if (std::system("command -v python3 > /dev/null") != 0) GTEST_SKIP() << "no python3";
  const TemporaryFolder folder;
  const std::string photographs = "data/reference/differential_rendering/kartikagrawal27/Materials";
  std::filesystem::create_directories(folder / photographs);
  std::filesystem::create_directories(folder / "out");
  std::ofstream(folder / "stubs.py")
      << "import pathlib, sys, types\n"
         "import course, light, main, plate\n"
         "class Run:\n"
         "    def __init__(self, scratch, pictures):\n"
         "        self.scratch = scratch\n"
         "main.Run, main.Photographs, main.page = Run, lambda run: None, lambda *parts: 'page'\n"
         "light.steps = plate.steps = lambda *arguments: []\n"
         "course.exposures = lambda run: ['made']\n"
         "course.ball = course.camera = course.composite = lambda run: []\n"
         "course.merged = lambda run, folder: []\n"
         "course.RECORD = pathlib.Path('course_record.md').resolve()\n"
         "main.main()\n";
  const std::string scripts = std::string(kSourceDir) + "/tools/scripts/",
                    run = "cd '" + folder / "" + "' && CHROMEBALL_DATA=data PYTHONPATH=" + scripts +
                          "shared:" + scripts + "capture_tutorial PYTHONDONTWRITEBYTECODE=1 ";
  ASSERT_EQ(std::system((run + "python3 stubs.py --out out > /dev/null").c_str()), 0);
  EXPECT_EQ(fileContents(folder / "out/course_record.md"), "made\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "course_record.md"));
}

// In the first lines of code of docs/farm.md.
TEST(FarmPage, MergesNoPartialFiles) {
  const TemporaryFolder folder;
  for (const char* file : {"part-1.exr", "part-1.partial.exr", "part-2.exr"})
    std::ofstream(folder / file) << "";
  std::string page = fileContents(std::string(kSourceDir) + "/docs/farm.md");
  const size_t from = page.find("chromeball merge ") + 17, to = page.find(" -o", from);
  ASSERT_LT(to, page.size());
  std::string list = page.substr(from, to - from);
  list.replace(list.find('N'), 1, "2");
  std::ofstream(folder / "list.sh") << "echo " + list;
  const std::string line = "cd '" + folder / "" + "' && bash list.sh > out";
  ASSERT_EQ(std::system(line.c_str()), 0);
  EXPECT_EQ(fileContents(folder / "out"), "part-1.exr part-2.exr\n");
}

}  // namespace
}  // namespace scripts_test
