// SPDX-License-Identifier: Apache-2.0
// Use of the library by other projects: tests/consumer is a separate project, built against an
// installed copy and configured with this source tree as a subdirectory.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/json.h"
#include "image/io/read_image.h"
#include "json_file.h"
#include "math/vec.h"
#include "paths.h"
#include "run_command.h"

namespace chromeball::consumer_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSkipped = "the build is instrumented, or has no install rules";
constexpr bool kCanInstall = CHROMEBALL_INSTALLS && !CHROMEBALL_INSTRUMENTED;

std::string quoted(const std::string& text) { return "'" + text + "'"; }

// Runs a shell command and returns its output; if it fails, so does the test, with the output.
std::string run(const std::string& command) {
  const TemporaryFolder folder;
  const int status = std::system((command + " > " + folder / "out" + " 2>&1").c_str());
  const std::string output = fileContents(folder / "out");
  EXPECT_EQ(status, 0) << command << "\n" << output;
  return output;
}

std::string configureConsumer(const std::string& folder, const std::string& option) {
  return run(quoted(CHROMEBALL_CMAKE) + " -G 'Unix Makefiles' -S " +
             quoted(std::string(kSourceDir) + "/tests/consumer") + " -B " + quoted(folder) +
             " -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=" + quoted(CHROMEBALL_COMPILER) +
             " " + quoted(option));
}

std::string writeScene(const TemporaryFolder& folder) {
  const std::string root = std::string(kSourceDir) + "/";
  std::ofstream(folder / "scene.toml") << "model = \"" << root << "scenes/models/pillars.gltf\"\n"
                                       << "[probe]\nfile = \"" << root << "probes/dusk.exr\"\n"
                                       << "[render]\nsize = [24, 16]\nsamples = 4\n";
  return folder / "scene.toml";
}

// Mean of a colour PFM that the command wrote: three lines of text, then little-endian floats.
glm::dvec3 meanOfPfm(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(file, line);
  glm::dvec3 sum(0);
  int pixels = 0;
  for (float rgb[3]; file.read(reinterpret_cast<char*>(rgb), sizeof rgb); ++pixels)
    sum += glm::dvec3(rgb[0], rgb[1], rgb[2]);
  return sum / double(pixels);
}

TEST(SlowConsumer, InstalledLibraryRendersLikeTheCommand) {
  if (!kCanInstall) GTEST_SKIP() << kSkipped;
  const TemporaryFolder prefix, folder;
  const std::string installed = prefix / "", build = folder / "build";
  run(quoted(CHROMEBALL_CMAKE) + " --install " + quoted(kBuildDir) + " --prefix " +
      quoted(installed));
  configureConsumer(build, "-DCMAKE_PREFIX_PATH=" + installed);
  run(quoted(CHROMEBALL_CMAKE) + " --build " + quoted(build));

  const std::string scene = writeScene(folder);
  std::istringstream printed(run(quoted(build + "/consumer") + " " + quoted(scene)));
  run(quoted(installed + "/bin/chromeball") + " render " + quoted(scene) + " -o " +
      quoted(folder / "command.pfm"));
  const glm::dvec3 expected = meanOfPfm(folder / "command.pfm");

  int width = 0, height = 0;
  glm::dvec3 mean(0);
  printed >> width >> height >> mean.x >> mean.y >> mean.z;
  EXPECT_EQ(width, 24);
  EXPECT_EQ(height, 16);
  // Not bit-identical: the consumer is compiled without FMA and may instantiate inline functions.
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean[c], expected[c], 1e-5 * expected[c]) << "channel " << c;

  // The other programs of docs/library.md.
  const std::string printedByArrays =
      run("cd " + quoted(folder / "") + " && " + quoted(build + "/arrays"));
  EXPECT_NE(printedByArrays.find(" snapshots"), std::string::npos) << printedByArrays;
  const Image first = readImage(folder / "first.exr"), turned = readImage(folder / "turned.exr");
  EXPECT_EQ(first.width, 160);
  EXPECT_NE(first.texels, turned.texels);
  std::istringstream errors(run(quoted(build + "/strategy") + " " + quoted(scene)));
  std::map<std::string, double> relMse;
  std::string name;
  for (double error; errors >> name >> error;) relMse[name] = error;
  ASSERT_EQ(relMse.size(), 3u);
  EXPECT_GT(relMse["importance"], 0);
  EXPECT_LT(relMse["importance"], relMse["cosine"]);  // there is a sun
  EXPECT_LT(relMse["cosine"], 5 * relMse["uniform"]);
}

// The page's programs are these.
TEST(Consumer, TheLibrarysPageHasThePrograms) {
  const std::string page = fileContents(std::string(kSourceDir) + "/docs/library.md");
  for (const char* program : {"main.cpp", "arrays.cpp", "strategy.cpp"}) {
    std::string code = fileContents(std::string(kSourceDir) + "/tests/consumer/" + program);
    code = code.substr(code.find("#include"));
    EXPECT_NE(page.find(code), std::string::npos) << program;
  }
}

TEST(SlowConsumer, InstalledFilesAreComplete) {
  if (!kCanInstall) GTEST_SKIP() << kSkipped;
  const TemporaryFolder prefix;
  run(quoted(CHROMEBALL_CMAKE) + " --install " + quoted(kBuildDir) + " --prefix " +
      quoted(prefix / ""));
  for (const char* file :
       {"bin/chromeball", "share/man/man1/chromeball.1", "share/doc/chromeball/LICENSE",
        "share/bash-completion/completions/chromeball", "share/zsh/site-functions/_chromeball",
        "share/zsh/vendor-completions/_chromeball",
        "share/fish/vendor_completions.d/chromeball.fish", "share/chromeball/still-life.glb",
        "share/chromeball/dusk.exr", "include/chromeball/render.h"})
    EXPECT_TRUE(fs::exists(prefix / file)) << file;
}

// Every installed header compiles with only the public dependencies.
TEST(SlowConsumer, InstalledHeadersCompile) {
  if (!kCanInstall) GTEST_SKIP() << kSkipped;
  const TemporaryFolder prefix;
  run(quoted(CHROMEBALL_CMAKE) + " --install " + quoted(kBuildDir) + " --prefix " +
      quoted(prefix / ""));
  const fs::path include = prefix / "include";
  std::ofstream source(prefix / "all.cpp");
  int headers = 0;
  for (const auto& entry : fs::recursive_directory_iterator(include / "chromeball"))
    if (entry.is_regular_file()) {
      source << "#include <" << entry.path().lexically_relative(include).generic_string() << ">\n";
      EXPECT_EQ(fileContents(entry.path()).find("#include \""), std::string::npos) << entry.path();
      ++headers;
    }
  source.close();
  EXPECT_LT(headers, 120);
  int ours = 0;  // to be included; the others are theirs
  for (const auto& entry : fs::directory_iterator(include / "chromeball"))
    ours += entry.is_regular_file();
  EXPECT_LE(ours, 12);
  run(quoted(CHROMEBALL_COMPILER) +
      " -std=c++20 -fsyntax-only -Wall -Werror -DGLM_FORCE_SILENT_WARNINGS -DGLM_FORCE_XYZW_ONLY "
      "-I " +
      quoted(include) + " " + quoted(prefix / "all.cpp"));
}

TEST(SlowConsumer, EveryPresetConfigures) {
  const std::string source = quoted(kSourceDir), cmake = quoted(CHROMEBALL_CMAKE);
  const auto presets = jsonOfFile(std::string(kSourceDir) + "/CMakePresets.json");
  EXPECT_EQ(presets["configurePresets"].size(), 6u);
  const bool hasClang = std::system("command -v clang++ > /dev/null") == 0;
  for (const auto& preset : presets["configurePresets"]) {
    const std::string name = preset["name"];
    if (preset["cacheVariables"].value("CMAKE_CXX_COMPILER", "") == "clang++" && !hasClang)
      continue;
    const TemporaryFolder folder;
    run("cd " + source + " && " + cmake + " --preset " + name + " -B " + quoted(folder / "build"));
  }
}

// Compiles only the consumer's own source: the library takes minutes and is tested above.
TEST(SlowConsumer, ConfiguresAndCompilesWithTheSourceTreeAsSubdirectory) {
  const TemporaryFolder folder;
  const std::string build = folder / "build";
  configureConsumer(build, "-DCHROMEBALL_SOURCE=" + std::string(kSourceDir));
  run(quoted(CHROMEBALL_CMAKE) + " --build " + quoted(build) + " --target chromeball_headers");
  run("make -C " + quoted(build) + " main.o");
  const std::string targets =
      run(quoted(CHROMEBALL_CMAKE) + " --build " + quoted(build) + " --target help");
  EXPECT_NE(targets.find("chromeball_renderer"), std::string::npos);
  for (const char* ours : {"... tests\n", "... benchmarks\n", "... make_demo\n"})
    EXPECT_EQ(targets.find(ours), std::string::npos)
        << ours << " is also a target of the consumer's project";
}

}  // namespace
}  // namespace chromeball::consumer_test
