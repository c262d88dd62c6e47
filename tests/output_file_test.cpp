// SPDX-License-Identifier: Apache-2.0
// No command overwrites its input files, or one of its outputs with another.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::output_file_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A folder with all inputs of a composite: scene file, plate, probe, model with buffer and texture,
// and a model of the room.
class SlowOutputFiles : public testing::Test {
 protected:
  void SetUp() override {
    room_.add("nodes", {{"mesh", room_.mesh({{"attributes", {{"POSITION", room_.vec3s(kBox)}}}})}});
    room_.save();
    model_.write("wood.png", kPng);
    model_.add("images", {{"uri", "wood.png"}});
    model_.add("textures", {{"source", 0}});
    model_.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    addTriangle(model_, {{"material", 0}}, {{"name", "ground"}});
    addTriangle(model_, {{"material", 0}}, {{"name", "thing"}});
    model_.save();
    writeImage(in("probe.exr"), constantProbe({8, 4}, Rgb(1)));
    writeImage(in("plate.exr"), constantProbe({8, 4}, Rgb(1)));
    fs::copy(room_.folder(), in("room"));
    std::ofstream(in("scene.toml")) << "model = \"model.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
                                       "[composite]\nplate = \"plate.exr\"\n"
                                       "local_scene = [\"ground\"]\n[surroundings]\n"
                                       "shape = \"model\"\nfile = \"room/model.gltf\"\n"
                                       "capture = [0, 0, 0]\n";
  }

  std::string in(const std::string& name) const { return (model_.folder() / name).string(); }

  // Expects an error with `reason` and no changes in the folder.
  void expectErrorWithoutChanges(const Words& words, const std::string& reason) const {
    const auto contents = [&] {
      std::vector<std::string> all;
      for (const auto& entry : fs::recursive_directory_iterator(model_.folder()))
        if (entry.is_regular_file())
          all.push_back(entry.path().string() + fileContents(entry.path().string()));
      std::sort(all.begin(), all.end());
      return all;
    };
    const auto before = contents();
    expectError(words, reason);
    EXPECT_EQ(contents(), before) << reason;
  }

  static constexpr const char* kInput = "would overwrite the input";
  inline static const std::vector<float> kBox = {-9, -9, -9, 9, -9, -9, 0, 9, -9,
                                                 -9, -9, 9,  9, -9, 9,  0, 9, 9};
  GltfWriter model_, room_;
};

TEST_F(SlowOutputFiles, RenderDoesNotOverwriteItsInputs) {
  const auto render = [&](const std::string& output, const Words& more = {}) {
    Words words{"render", in("scene.toml"), "--samples", "1", "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  for (const char* name : {"probe.exr", "plate.exr", "wood.png"})
    expectErrorWithoutChanges(render(in(name)), kInput);
  for (const char* name : {"scene.toml", "model.gltf", "data.bin", "room/model.gltf",
                           "room/data.bin"}) {  // through a link with the file name of an image
    fs::create_symlink(in(name), in("link.exr"));
    expectErrorWithoutChanges(render(in("link.exr")), kInput);
    fs::remove(in("link.exr"));
  }
  fs::create_hard_link(in("probe.exr"), in("same.exr"));
  expectErrorWithoutChanges(render(in("same.exr")), kInput);
  expectErrorWithoutChanges(
      render((model_.folder() / ".." / model_.folder().filename() / "probe.exr").string()), kInput);
  fs::create_symlink(in("model.gltf"), in("link.json"));
  expectErrorWithoutChanges(render(in("a.exr"), {"--stats", in("link.json")}), kInput);
  // Two outputs with the same path, although the file does not exist yet.
  constexpr const char* kOther = "would overwrite the other output";
  expectErrorWithoutChanges(render(in("a.exr"), {"-o", in("a.exr")}), kOther);
  fs::create_directory_symlink(in("room"), in("again"));
  expectErrorWithoutChanges(render(in("room/a.exr"), {"-o", in("again/a.exr")}), kOther);
  std::ofstream(in("a.json")) << "old";
  fs::create_symlink(in("a.json"), in("b.exr"));
  expectErrorWithoutChanges(render(in("b.exr"), {"--stats", in("a.json")}), kOther);
  // The same through links, the last of which leads to no file yet.
  fs::create_symlink("missing.exr", in("dangling.exr"));
  fs::create_symlink(in("dangling.exr"), in("chain.exr"));
  expectErrorWithoutChanges(render(in("missing.exr"), {"-o", in("chain.exr")}), kOther);
  expectErrorWithoutChanges(render(in("dangling.exr"), {"-o", in("chain.exr")}), kOther);
  const Words cached{
      "render",          in("model.gltf"),     "--probe", in("probe.exr"), "-o",
      in("missing.exr"), "--irradiance-cache", "0.1",     "--cache",       in("chain.exr")};
  expectErrorWithoutChanges(cached, kOther);
  // Any other path is written.
  const CommandResult result = runCommand(render(in("fresh.exr"), {"--quiet"}));
  EXPECT_EQ(result.status, 0) << result.error;
}

// A file's name has at most 255 bytes; the temporary file has one where the file has.
TEST_F(SlowOutputFiles, LongNamesAreWrittenOrRefusedBeforeRendering) {
  const auto render = [&](size_t length) {
    return Words{"render",
                 in("model.gltf"),
                 "--probe",
                 in("probe.exr"),
                 "--size",
                 "8x8",
                 "--samples",
                 "1",
                 "--quiet",
                 "-o",
                 in(std::string(length - 4, 'a') + ".exr")};
  };
  for (const size_t length : {190u, 192u, 240u, 244u, 255u}) {
    const CommandResult result = runCommand(render(length));
    EXPECT_EQ(result.status, 0) << length << ": " << result.error;
    EXPECT_TRUE(fs::exists(render(length).back())) << length;
  }
  expectErrorWithoutChanges(render(256), "File name too long");
}

TEST_F(SlowOutputFiles, OtherCommandsDoNotOverwriteTheirInputs) {
  const std::string probe = in("probe.exr"), plate = in("plate.exr");
  expectErrorWithoutChanges({"probe", "convert", probe, probe, "--to", "angular"}, kInput);
  expectErrorWithoutChanges({"probe", "irradiance", probe, probe}, kInput);
  fs::create_symlink(probe, in("link.png"));
  expectErrorWithoutChanges({"image", "view", probe, in("link.png")}, kInput);
  expectErrorWithoutChanges({"image", "error", plate, probe, "-o", in("link.png")}, kInput);
  expectErrorWithoutChanges({"image", "error", probe, plate, "-o", in("link.png")}, kInput);
  for (const char* name : {"a.json", "a.csv", "a.svg"}) fs::create_symlink(probe, in(name));
  const Words lights = {"lights", probe, "--method", "median-cut", "--count", "4"};
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expectErrorWithoutChanges(with(lights, {"-o", in("a.json")}), kInput);
  expectErrorWithoutChanges(with(lights, {"-o", in("b.json"), "--preview", probe}), kInput);
  expectErrorWithoutChanges(with(lights, {"-o", in("b.json"), "--sphere", probe}), kInput);
  const Words errors = {"lights-error", probe, "--methods", "median-cut", "--counts", "2"};
  expectErrorWithoutChanges(with(errors, {"--csv", in("a.csv")}), kInput);
  expectErrorWithoutChanges(with(errors, {"--plot", in("a.svg")}), kInput);
  std::ofstream(in("new.svg")) << "old";
  fs::create_hard_link(in("new.svg"), in("new.csv"));
  expectErrorWithoutChanges(with(errors, {"--csv", in("new.csv"), "--plot", in("new.svg")}),
                            "the other output");
  fs::create_directory(in("report"));
  fs::create_symlink(probe, in("report/index.html"));
  expectErrorWithoutChanges({"compare", in("model.gltf"), "--probe", probe, "--size", "8x8",
                             "--samples", "1", "-o", in("report")},
                            kInput);
}

// A folder that is a probe is read by its six files; another name in it is free.
TEST_F(SlowOutputFiles, FacesOfACubeMapAreInputs) {
  fs::create_directory(in("cube"));
  for (const char* name : {"front", "back", "left", "right", "top", "bottom"})
    writeImage(in("cube/" + std::string(name) + ".exr"), constantProbe({8, 8}, Rgb(1)));
  fs::create_directory_symlink("cube", in("link"));
  const std::string cube = in("cube"), front = in("cube/front.exr");
  const std::string reason = "would overwrite the input " + front;
  std::ofstream(in("sun.json")) << "{}";
  for (const Words& words : {
           Words{"probe", "convert", cube, front, "--to", "lat-long"},
           Words{"probe", "convert", cube, in("link/front.exr"), "--to", "lat-long"},
           Words{"probe", "edit", cube, front, "--scale", "2"},
           Words{"probe", "irradiance", cube, front},
           Words{"probe", "convolve", cube, front, "--kernel", "diffuse"},
           Words{"probe", "crop", cube, front, "--size", "16x12"},
           Words{"probe", "split", cube, "--suns", in("a.json"), "--rest", front},
           Words{"probe", "add-sun", cube, front, "--lights", in("sun.json")},
           Words{"probe", "align", cube, in("probe.exr"), "-o", front},
           Words{"lights", cube, "--method", "median-cut", "--count", "4", "-o", in("a.json"),
                 "--preview", front},
           Words{"image", "relight", in("plate.exr"), "-o", front, "--probe", cube},
       })
    expectErrorWithoutChanges(words, reason);
  const CommandResult result =
      runCommand({"probe", "edit", cube, in("cube/brighter.exr"), "--scale", "2"});
  EXPECT_EQ(result.status, 0) << result.error;
}

// The file at the end of the links is replaced, and they stay; anything that is no file is refused
// first.
TEST_F(SlowOutputFiles, LinksAreFollowedAndSpecialFilesRefused) {
  const auto render = [&](const std::string& output) {
    return Words{"render", in("scene.toml"), "--samples", "1", "--quiet", "-o", output};
  };
  fs::create_directory(in("far"));
  fs::create_symlink("far/real.exr", in("link.exr"));  // there is none yet
  fs::create_symlink("link.exr", in("second.exr"));
  for (const char* name : {"link.exr", "second.exr"}) {
    const CommandResult result = runCommand(render(in(name)));
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_TRUE(fs::is_symlink(in(name)));
    EXPECT_TRUE(fs::is_regular_file(in("far/real.exr")));
    fs::remove(in("far/real.exr"));
  }
  fs::create_symlink("circle.exr", in("circle.exr"));
  EXPECT_EQ(runCommand(render(in("circle.exr"))).status, 2);
  ASSERT_EQ(mkfifo(in("pipe.exr").c_str(), 0600), 0);
  fs::create_symlink("/dev/null", in("null.exr"));
  fs::create_symlink("pipe.exr", in("to_pipe.exr"));
  for (const auto& [name, what] : {std::pair{"pipe.exr", "is a FIFO"},
                                   {"to_pipe.exr", "is a FIFO"},
                                   {"null.exr", "is a device"}}) {
    const CommandResult result = runCommand(render(in(name)));
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.error.find(what), std::string::npos) << result.error;
  }
  EXPECT_TRUE(fs::is_fifo(in("pipe.exr")));
}

// The folder of an output path in the scene file is created if its parent exists; the folder of
// --output must exist.
TEST_F(SlowOutputFiles, TheOutputFolderOfASceneFileIsCreated) {
  const auto scene = [&](const std::string& output) {
    std::ofstream(in("plain.toml")) << "model = \"model.gltf\"\n[probe]\nfile = \"probe.exr\"\n"
                                       "[render]\nsize = [8, 8]\nsamples = 1\n[output]\nfile = \""
                                    << output << "\"\n";
    return in("plain.toml");
  };
  const CommandResult result = runCommand({"render", scene("out/a.exr"), "--quiet"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_TRUE(fs::exists(in("out/a.exr")));
  EXPECT_EQ(runCommand({"render", scene("out/a.exr"), "--quiet"}).status, 0);
  expectError({"render", scene("none/deeper/a.exr")}, "no folder");
  expectError({"render", scene("out/a.exr"), "-o", in("none/a.exr")}, "no folder");
  expectError({"render", scene("other/a.gif")}, "unknown image format");
  expectError({"render", scene("other/a.exr"), "--strategy", "nonsense"}, "nonsense");
  EXPECT_FALSE(fs::exists(in("none")));
  EXPECT_FALSE(fs::exists(in("other")));
}

}  // namespace
}  // namespace chromeball::output_file_test
