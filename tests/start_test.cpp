// SPDX-License-Identifier: Apache-2.0
// The cost of a start: the shared libraries that the command loads, and when it loads the module
// libchromeball_imageio.so.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <set>
#include <sstream>

#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "test_probes.h"

namespace chromeball::start_test {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostLibraries = 45;
constexpr const char* kModule = "libchromeball_imageio.so";

std::string seedPath(const std::string& name) {
  return std::string(kSourceDir) + "/tests/fuzz/seeds/image/" + name;
}

// The libraries that a run of `command` maps, by the dynamic linker's own account.
std::set<std::string> librariesOf(const std::string& command) {
  const TemporaryFolder folder;
  const std::string run = "LD_DEBUG=files LD_DEBUG_OUTPUT=" + folder / "debug" + " " + command +
                          " > /dev/null 2> " + folder / "error";
  EXPECT_EQ(std::system(run.c_str()), 0) << command << "\n" << fileContents(folder / "error");
  std::set<std::string> libraries;
  for (const std::string& name : folder.files()) {
    if (!name.starts_with("debug")) continue;
    std::istringstream lines(fileContents(folder / name));
    for (std::string line; std::getline(lines, line);) {
      constexpr std::string_view kInit = "calling init: ";
      const size_t at = line.find(kInit);
      if (at != std::string::npos)
        libraries.insert(fs::path(line.substr(at + kInit.size())).filename().string());
    }
  }
  EXPECT_TRUE(libraries.contains("libc.so.6"));
  return libraries;
}

std::string quoted(const std::string& text) { return "'" + text + "'"; }

TEST(Start, LoadsFewLibraries) {
  const TemporaryFolder folder;
  const std::string command = quoted(kCommand);
  ASSERT_EQ(std::system(("ldd " + command + " > " + folder / "ldd").c_str()), 0);
  const std::string listed = fileContents(folder / "ldd");
  EXPECT_LE(size_t(std::count(listed.begin(), listed.end(), '\n')), kMostLibraries) << listed;
  for (const char* option : {" --version", " --help"})
    EXPECT_LE(librariesOf(command + option).size(), kMostLibraries);
}

// A model with a PNG and a JPEG, under each kind of probe, to each kind of image.
TEST(SlowStart, ARenderDoesNotLoadTheModule) {
  GltfWriter model;
  model.write("a.png", kPng);
  const std::string jpeg = fileContents(seedPath("a.jpg"));
  model.write("b.jpg", {jpeg.begin(), jpeg.end()});
  model.add("images", {{"uri", "a.png"}});
  model.add("images", {{"uri", "b.jpg"}});
  for (int i = 0; i < 2; ++i) {
    model.add("textures", {{"source", i}});
    model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    addTriangle(model, {{"material", i}});
  }
  const std::string path = model.save();
  for (const char* probe : {"p.hdr", "p.exr"}) {
    writeImage(model.folder() / probe, constantProbe({8, 4}, Rgb(1)));
    for (const char* output : {"out.exr", "out.png"}) {
      const auto libraries = librariesOf(quoted(kCommand) + " render " + quoted(path) +
                                         " --probe " + quoted((model.folder() / probe).string()) +
                                         " --size 8x8 --samples 1 --quiet -o " +
                                         quoted((model.folder() / output).string()));
      EXPECT_LE(libraries.size(), kMostLibraries);
      EXPECT_FALSE(libraries.contains(kModule));
    }
  }
}

TEST(SlowStart, ATiffLoadsTheModule) {
  const TemporaryFolder folder;
  const auto libraries = librariesOf(quoted(kCommand) + " image view " + quoted(seedPath("a.tif")) +
                                     " " + folder / "out.png");
  EXPECT_TRUE(libraries.contains(kModule));
  EXPECT_TRUE(fs::exists(folder / "out.png"));
}

TEST(SlowStart, WithoutTheModuleATiffIsRefusedByName) {
  const TemporaryFolder folder;
  const std::string alone = folder / "chromeball";
  fs::copy_file(kCommand, alone);
  const auto status = [&](const std::string& image) {
    return std::system((quoted(alone) + " image view " + quoted(image) + " " + folder / "out.png" +
                        " 2> " + folder / "error")
                           .c_str());
  };
  EXPECT_EQ(status(seedPath("a.jpg")), 0);
  const int refused = status(seedPath("a.tif"));
  EXPECT_EQ(WEXITSTATUS(refused), 2);
  const std::string error = fileContents(folder / "error");
  EXPECT_NE(error.find(kModule), std::string::npos) << error;
  EXPECT_NE(error.find("chromeball-tiff"), std::string::npos) << error;
  EXPECT_NE(error.find("a.tif"), std::string::npos) << error;
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
}

// The layout of an installation: bin/ and lib/, wherever they are.
TEST(SlowStart, TheModuleIsFoundInAMovedInstallation) {
  const TemporaryFolder folder;
  const std::string command = "cmake --install " + quoted(kBuildDir) + " --prefix " +
                              quoted(folder / "a") + " > " + folder / "log" + " 2>&1";
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "no install rules";
  fs::rename(folder / "a", folder / "b");
  EXPECT_EQ(std::system((quoted(folder / "b/bin/chromeball") + " image view " +
                         quoted(seedPath("a.tif")) + " " + folder / "out.png")
                            .c_str()),
            0);
}

}  // namespace
}  // namespace chromeball::start_test
