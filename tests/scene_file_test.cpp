// SPDX-License-Identifier: Apache-2.0
#include "front/scene_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "paths.h"
#include "scene/builder/scene_builder.h"

namespace chromeball::scene_file_test {
namespace {

namespace fs = std::filesystem;

// A folder with an (empty) model and probe, and the scene file under test in a subfolder.
class SceneFileTest : public testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / fmt::format("chromeball-scene-file-{}", getpid());
    fs::create_directories(root_ / "scenes");
    std::ofstream(root_ / "ball.glb") << "x";
    std::ofstream(root_ / "sky.exr") << "x";
  }
  void TearDown() override { fs::remove_all(root_); }

  std::string scenePath() const { return (root_ / "scenes/test.toml").string(); }
  SceneFile read(const std::string& toml) const {
    std::ofstream(scenePath(), std::ios::binary) << toml;
    return readSceneFile(scenePath());
  }
  // The text begins on line 2, so that a line number of 1 is always wrong.
  SceneFile readWithModel(const std::string& toml) const {
    return read("model = '../ball.glb'\n" + toml);
  }
  std::string errorOf(const std::string& toml) const {
    try {
      readWithModel(toml);
    } catch (const InputError& error) {
      return error.what();
    }
    return "(no error)";
  }
  // Expects an error of one line that names `line` of the scene file and contains all of `words`.
  void expectError(const std::string& toml, int line, const std::vector<std::string>& words) const {
    const std::string error = errorOf(toml);
    const std::string location = fmt::format("{}:{}: ", scenePath(), line);
    EXPECT_EQ(error.substr(0, location.size()), location) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    for (const auto& word : words)
      EXPECT_NE(error.find(word, location.size()), std::string::npos) << word << " in: " << error;
  }

  fs::path root_;
};

TEST_F(SceneFileTest, FilesThatAreNoneAreNamed) {
  ASSERT_EQ(mkfifo((root_ / "pipe").c_str(), 0600), 0);
  for (const char* entry : {"[[light]]\nfile = ", "[probe]\nfile = ", "[camera]\nfile = "}) {
    expectError(std::string(entry) + "'../pipe'", 3, {"`file`: ", "pipe: not a regular file"});
    if (!std::string(entry).starts_with("[probe]"))  // a folder may hold the faces of a cube
      expectError(std::string(entry) + "'..'", 3, {"not a regular file"});
    expectError(std::string(entry) + "'none'", 3, {"none: no such file", "relative to the scene"});
  }
}

TEST_F(SceneFileTest, AModelAloneSetsNothingElse) {
  const SceneFile scene = readWithModel("");
  ASSERT_EQ(scene.models.size(), 1u);
  EXPECT_EQ(scene.models[0].file, (root_ / "ball.glb").string());
  EXPECT_EQ(scene.models[0].placement.point({1, 2, 3}), vec3(1, 2, 3));
  EXPECT_FALSE(scene.camera || scene.lens || scene.composite || scene.surroundings);
  for (const Setting& setting : settingTable())
    EXPECT_FALSE(scene.settings.has(setting.name())) << setting.name();
}

TEST_F(SceneFileTest, LightsDepthsAndSides) {
  const SceneFile scene = readWithModel(
      "[lighting]\nlights = 0.25\nlight_units = 'radiometric'\n"
      "[render]\nmax_transmission_depth = 12\nsingle_sided = 'light'");
  const Settings& s = scene.settings;
  EXPECT_EQ(s.get<double>("lighting.lights"), 0.25);
  EXPECT_EQ(s.get<std::string>("lighting.light_units"), "radiometric");
  EXPECT_EQ(s.get<uint64_t>("render.max_transmission_depth"), 12u);
  EXPECT_EQ(s.get<std::string>("render.single_sided"), "light");
  EXPECT_EQ(s.location("render.single_sided"), scenePath() + ":7");
  EXPECT_EQ(readWithModel("[lighting]\nlights = 'off'").settings.get<double>("lighting.lights"), 0);
  expectError("[lighting]\nlights = 'on'", 3, {"`lights` must be \"off\" or a factor"});
  expectError("[lighting]\nlights = -1", 3, {"`lights` must be \"off\" or a factor"});
  expectError("[render]\nmax_transmision_depth = 2", 3, {"max_transmission_depth"});
  expectError("light = 3", 2, {"`light` must be a table"});
}

// Fuzzing found that an assertion of the TOML library ended the process.
TEST_F(SceneFileTest, InvalidHeadersAreErrors) {
  for (const char* header : {"[[&odel]]", "[[ &]]", "[&]", "[a.&]"})
    expectError(header, 2, {"not valid TOML", "&"});
}

TEST_F(SceneFileTest, AModelMayShowAnAnimation) {
  const auto choice = [&](const std::string& keys) {
    return read("[[model]]\nfile = '../ball.glb'\n" + keys).models.at(0).choice;
  };
  EXPECT_FALSE(choice("").animation);
  const auto walk = choice("animation = 'Walk'\ntime = 1.5").animation;
  ASSERT_TRUE(walk);
  EXPECT_EQ(walk->name, "Walk");
  EXPECT_EQ(walk->seconds, 1.5);
  EXPECT_EQ(read("[[model]]\nfile = '../ball.glb'\nanimation = 'Walk'")
                .origins.of("models[0].choice.animation"),
            scenePath() + ":3");
  EXPECT_EQ(choice("time = 2").animation->name, "");
}

TEST_F(SceneFileTest, CamerasMayBeOrthographicOrHaveALens) {
  const std::string location = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
  const SceneFile parallel = readWithModel(location + "orthographic = 3");
  EXPECT_TRUE(parallel.camera->relativeTo({}).orthographic);
  EXPECT_EQ(parallel.camera->relativeTo({}).halfHeight, 1.5f);
  EXPECT_FALSE(parallel.lens);
  const SceneFile lens = readWithModel("[camera]\naperture = 0.05\nfocus = 2");
  EXPECT_FALSE(lens.camera);
  EXPECT_EQ(lens.lens->aperture, 0.05f);
  EXPECT_EQ(lens.lens->focus, 2);
  expectError("[camera]\naperture = 0.05", 3, {"`focus`", "go together"});
  expectError("[camera]\naperture = 0\nfocus = 1", 3, {"`aperture`", "above 0"});
  expectError(location + "fov = 40\northographic = 3", 5, {"orthographic", "no `fov`"});
  expectError(location + "orthographic = -3", 5, {"`orthographic`", "above 0"});
}

// Places are rounded to float only relative to the scene's origin.
TEST_F(SceneFileTest, PlacesFarFromTheOriginAreExact) {
  const SceneFile scene = readWithModel(R"([camera]
position = [3761603.3, 0, -3870317.7]
look_at = [3761603.4, 0, -3870317.7]
[[light]]
type = "point"
position = [3761603.1, 0, 0]
intensity = 1
[surroundings]
shape = "box"
min = [3761600.1, -1, -3870318]
max = [3761604.7, 1, -3870316]
)");
  const glm::dvec3 origin(3761603, 0, -3870317);
  const Camera camera = scene.camera->relativeTo(origin);
  EXPECT_NEAR(camera.position.x, 0.3f, 1e-6);
  EXPECT_NEAR(camera.position.z, -0.7f, 1e-6);
  EXPECT_NEAR(camera.back.x, -1, 1e-6);
  Scene lit;
  addLamp(lit, scene.lamps.at(0), origin);
  EXPECT_NEAR(lit.lights.at(0).position.x, 0.1f, 1e-6);
  EXPECT_NEAR(scene.surroundings->relativeTo(origin).max.x, 1.7f, 1e-6);
  EXPECT_NEAR(scene.surroundings->relativeTo(origin).capture.x, -0.6f, 1e-6);
}

TEST_F(SceneFileTest, EveryKeyIsRead) {
  const SceneFile scene = readWithModel(R"([camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
fov = 90
[probe]
file = "../sky.exr"
mapping = "lat-long"
rotation = -30
scale = 2.5
[lighting]
strategy = "median-cut:64"
mis = "power"
[render]
size = [800, 600]
samples = 256
max_depth = 0
seed = 7
time = 1.5
noise = 2
[output]
file = ["out/a.exr", "/b.png"]
aovs = ["albedo", "depth"]
)");
  ASSERT_TRUE(scene.camera);
  const Camera camera = scene.camera->relativeTo({});
  EXPECT_EQ(camera.position, vec3(0, 0, 5));
  EXPECT_EQ(camera.back, vec3(0, 0, 1));
  EXPECT_FLOAT_EQ(camera.fov, kPi / 2);
  const Settings& s = scene.settings;
  const auto text = [&](const char* name) { return s.get<std::string>(name); };
  const auto number = [&](const char* name) { return s.get<double>(name); };
  const auto count = [&](const char* name) { return s.get<uint64_t>(name); };
  EXPECT_EQ(text("probe.file"), (root_ / "sky.exr").string());
  EXPECT_EQ(text("probe.mapping"), "lat-long");
  EXPECT_EQ(s.get<std::vector<double>>("probe.rotation"), std::vector<double>{-30});
  EXPECT_EQ(s.get<std::vector<double>>("probe.scale"), std::vector<double>{2.5});
  EXPECT_EQ(text("lighting.strategy"), "median-cut:64");
  EXPECT_EQ(s.location("lighting.strategy"), scenePath() + ":12");
  EXPECT_EQ(text("lighting.mis"), "power");
  EXPECT_EQ(s.get<ImageSize>("render.size").width, 800);
  EXPECT_EQ(s.get<ImageSize>("render.size").height, 600);
  EXPECT_EQ(count("render.samples"), 256u);
  EXPECT_EQ(count("render.max_depth"), 0u);
  EXPECT_EQ(count("render.seed"), 7u);
  EXPECT_EQ(number("render.time"), 1.5);
  EXPECT_EQ(number("render.noise"), 2);
  using Words = std::vector<std::string>;
  EXPECT_EQ(s.get<Words>("output.file"), (Words{(root_ / "scenes/out/a.exr").string(), "/b.png"}));
  EXPECT_EQ(s.get<Words>("output.aovs"), (Words{"albedo", "depth"}));
}

TEST_F(SceneFileTest, CameraAndOutputByName) {
  const SceneFile scene = readWithModel("camera.name = 'Front'\noutput.file = 'a.exr'\n");
  EXPECT_EQ(scene.settings.get<std::string>("camera.name"), "Front");
  EXPECT_EQ(scene.settings.get<std::vector<std::string>>("output.file"),
            std::vector{(root_ / "scenes/a.exr").string()});
}

// T R S: (1, 2, 3) scaled by (2, 3, 4), rotated by 90 degrees about Y (z to x, x to -z),
// translated.
TEST_F(SceneFileTest, PlacementScalesThenRotatesThenTranslates) {
  const char* const rotations[] = {"[0, 90, 0]", "[0, 0.70710678, 0, 0.70710678]",
                                   "[0, 5.0, 0, 5.0]"};
  for (const char* rotation : rotations) {
    const SceneFile scene = read(fmt::format(
        "[[model]]\nfile='../ball.glb'\nscale=[2,3,4]\nrotation={}\ntranslation=[10,20,30]\n",
        rotation));
    const vec3 moved = scene.models.at(0).placement.point({1, 2, 3});
    EXPECT_LT(glm::distance(moved, vec3(10 + 12, 20 + 6, 30 - 2)), 1e-4f) << rotation;
  }
}

// Angles about fixed axes, X first: 90 degrees about X rotate y to z; 90 about Z then leave it
// there.
TEST_F(SceneFileTest, AnglesRotateAboutXThenYThenZ) {
  const SceneFile scene = read("[[model]]\nfile='../ball.glb'\nrotation=[90,0,90]\n");
  EXPECT_LT(glm::distance(scene.models.at(0).placement.point({0, 1, 0}), vec3(0, 0, 1)), 1e-6f);
  EXPECT_LT(glm::distance(scene.models.at(0).placement.point({1, 0, 0}), vec3(0, 1, 0)), 1e-6f);
}

TEST_F(SceneFileTest, SeveralModelsKeepTheirOrder) {
  const SceneFile scene =
      read("[[model]]\nfile='../sky.exr'\nscale=2\n[[model]]\nfile='../ball.glb'\n");
  ASSERT_EQ(scene.models.size(), 2u);
  EXPECT_EQ(scene.models[0].placement.point({1, 1, 1}), vec3(2, 2, 2));
  EXPECT_EQ(scene.models[1].file, (root_ / "ball.glb").string());
}

TEST_F(SceneFileTest, UnknownKeyNamesItsLineAndTheNearestKey) {
  expectError("[render]\nsampels = 3\n", 3, {"`sampels`", "[render]", "did you mean `samples`?"});
  expectError("[renderer]\n", 2, {"`renderer`", "did you mean [render]?"});
  expectError("[camera]\nlookat = [0,0,0]\n", 3, {"`lookat`", "`look_at`"});
  expectError("[probe]\nwattage = 3\n", 3,
              {"`wattage`", "file, mapping, rotation, rotation_keys, scale"});
  expectError("\"a\\nb\" = 3\n", 2, {"unknown key"});
}

// A file name ends at U+0000, so that a file other than the named one would be read or written.
TEST_F(SceneFileTest, StringsWithNulAreRefused) {
  const std::string reason = "must be a string without U+0000";
  expectError("[output]\nfile = \"o.pfm\\u0000.exr\"\n", 3, {"`file`", reason});
  expectError("[output]\nfile = ['a.exr', \"o.pfm\\u0000.exr\"]\n", 3, {"`file`", reason});
  expectError("[probe]\nfile = \"../sky.exr\\u0000x\"\n", 3, {"`file`", reason});
  expectError("[composite]\nplate = \"../sky.exr\\u0000\"\n", 3, {"`plate`", reason});
  expectError("[camera]\nname = \"\\u0000\"\n", 3, {"`name`", reason});
  expectError("[[light]]\ntype = 'list'\nfile = \"../sky.exr\\u0000x\"\n", 4, {"`file`", reason});
  EXPECT_THROW(read("[[model]]\nfile = \"../ball.glb\\u0000x\"\n"), InputError);
  EXPECT_THROW(read("model = \"../ball.glb\\u0000x\"\n"), InputError);
}

TEST_F(SceneFileTest, LongKeysAndValuesAreShortened) {
  for (const std::string& part : {std::string("k"), std::string("k ")}) {
    std::string text;
    while (text.size() < 1000000) text += part;
    for (const std::string& line :
         {"[render]\n'" + text + "' = 1", "[render]\nsamples = '" + text + "'",
          "[lighting]\nstrategy = '" + text + "'", "[probe]\nfile = '" + text + "'",
          "[[light]]\ntype = 'sun'\n'" + text + "' = 1"}) {
      const std::string error = errorOf(line);
      EXPECT_LE(error.size(), 1500u) << error;
    }
  }
}

TEST_F(SceneFileTest, WrongTypeNamesKeyAndLine) {
  expectError("[render]\n\nsamples = '16'\n", 4, {"`samples`", "whole number", "\"16\""});
  expectError("[render]\nsamples = 16.0\n", 3, {"whole number", "not 16.0"});
  expectError("[render]\nsamples = 1.5\n", 3, {"`samples`", "1.5"});
  expectError("[render]\nsize = 800\n", 3, {"`size`", "[width, height]"});
  expectError("[render]\nsize = [800]\n", 3, {"`size`", "an array of 1"});
  expectError("[render]\nsize = [800, true]\n", 3, {"`size`", "a boolean"});
  expectError("[render]\ntime = 12:00:00\n", 3, {"`time`", "a date or time"});
  expectError("render = 3\n", 2, {"`render`", "a table"});
  expectError("[probe]\nfile = 3\n", 3, {"`file`", "a string"});
  expectError("[probe]\nrotation = ['a']\n", 3, {"`rotation`", "a finite number"});
  expectError("[lighting]\nstrategy = 3\n", 3, {"`strategy`"});
  expectError("[output]\naovs = ['depth', 3]\n", 3, {"`aovs`"});
  expectError("[output]\nfile = ''\n", 3, {"`file`"});
  expectError("[camera]\nposition = [1, 2]\nlook_at = [0,0,0]\n", 3, {"`position`"});
}

TEST_F(SceneFileTest, OutOfRangeNamesKeyAndLine) {
  expectError("[render]\nsize = [0, 600]\n", 3, {"`size`", "0"});
  expectError("[render]\nsize = [800, -600]\n", 3, {"`size`", "-600"});
  expectError("[render]\nsize = [800, 65537]\n", 3, {"`size`", "65536"});
  expectError("[render]\nsamples = 0\n", 3, {"`samples`"});
  expectError("[render]\nsamples = 4294967297\n", 3, {"`samples`"});
  expectError("[render]\nmax_depth = -1\n", 3, {"`max_depth`"});
  expectError("[render]\nseed = -1\n", 3, {"`seed`"});
  expectError("[render]\ntime = 0\n", 3, {"`time`"});
  expectError("[render]\nnoise = nan\n", 3, {"`noise`", "nan"});
  expectError("[render]\ntime = inf\n", 3, {"`time`", "inf"});
  expectError("[probe]\nscale = -1\n", 3, {"`scale`"});
  expectError("[probe]\nrotation = 1e300\n", 3, {"`rotation`"});
  expectError("[camera]\nposition=[0,0,1]\nlook_at=[0,0,0]\nfov = 180\n", 5, {"`fov`"});
}

TEST_F(SceneFileTest, CameraHasEitherANameOrAPosition) {
  expectError("[camera]\nname = 'A'\nup = [0, 1, 0]\n", 4, {"`name`", "`up`"});
  expectError("\n[camera]\nposition = [0,0,1]\n", 3, {"look_at"});
  expectError("[camera]\nposition = [0,0,1]\nlook_at = [0,0,1]\n", 2, {"same point"});
  expectError("[camera]\nposition=[0,0,1]\nlook_at=[0,0,0]\nup=[0,0,1]\n", 2, {"parallel"});
}

TEST_F(SceneFileTest, BadModelsAreRejected) {
  const auto expectThrow = [&](const std::string& toml) {
    EXPECT_THROW(read(toml), InputError) << toml;
  };
  expectThrow("");
  expectThrow("model = []");
  expectThrow("model = 3");
  expectThrow("[[model]]\nscale = 2\n");
  expectThrow("[[model]]\nfile='../ball.glb'\nscale = 0\n");
  expectThrow("[[model]]\nfile='../ball.glb'\nscale = [1, 0, 1]\n");
  expectThrow("[[model]]\nfile='../ball.glb'\nrotation = [0, 0]\n");
  expectThrow("[[model]]\nfile='../ball.glb'\nrotation = [0, 0, 0, 0]\n");
  expectThrow("[[model]]\nfile='../ball.glb'\ntranslation = [0, nan, 0]\n");
}

TEST_F(SceneFileTest, MissingFilesAreNamedWithTheirLine) {
  expectError("[probe]\nfile = '../moon.exr'\n", 3, {"`file`", "moon.exr"});
  EXPECT_THROW(read("model = 'ball.glb'\n"), InputError);  // not relative to the working directory
}

// ".." leaves the folder that a link leads to, as for the system.
TEST_F(SceneFileTest, PathsLeaveLinkedFoldersAsTheSystemDoes) {
  fs::create_directories(root_ / "real/deep/scenes");
  fs::create_directory_symlink("real/deep/scenes", root_ / "link");
  std::ofstream(root_ / "real/deep/ball.glb") << "x";
  std::ofstream(root_ / "link/s.toml") << "model = '../ball.glb'\n";
  const SceneFile linked = readSceneFile((root_ / "link/s.toml").string());
  EXPECT_TRUE(fs::equivalent(linked.models[0].file, root_ / "real/deep/ball.glb"));
  EXPECT_FALSE(fs::equivalent(linked.models[0].file, root_ / "ball.glb"));
}

TEST_F(SceneFileTest, BrokenTomlNamesItsLine) {
  expectError("[render]\nsamples = \n", 3, {"TOML"});
  expectError("[render]\nsamples = 1\nsamples = 2\n", 4, {"TOML"});
  expectError("[render\n", 2, {"TOML"});
  expectError("[render]\nsamples = \xff\n", 3, {"TOML"});
  expectError("x = " + std::string(100000, '['), 2, {"TOML"});
}

TEST_F(SceneFileTest, CompositeNeedsPlateAndLocalScene) {
  expectError("[composite]\nlocal_scene = 'ground'\n", 2, {"[composite]", "plate"});
  expectError("[composite]\nplate = '../ball.glb'\n", 2, {"[composite]", "local_scene"});
  expectError("[composite]\nplate = 'none.exr'\nlocal_scene = 'a'\n", 3, {"no such file"});
}

TEST_F(SceneFileTest, InvalidFilesAreRejected) {
  EXPECT_THROW(readSceneFile((root_ / "none.toml").string()), InputError);
  EXPECT_THROW(readSceneFile(root_.string()), InputError);
  EXPECT_THROW(read("# " + std::string(size_t(5) << 20, 'x')), InputError);
}

TEST(SceneFileOfTheDemo, IsValidAndItsFilesExist) {
  for (const char* name : {"demo", "terrace"}) {
    const SceneFile scene = readSceneFile(std::string(kSourceDir) + "/scenes/" + name + ".toml");
    EXPECT_EQ(scene.models.size(), 1u);
    EXPECT_TRUE(scene.settings.has("probe.file") && scene.settings.has("render.samples"));
    EXPECT_EQ(scene.composite.has_value(), name == std::string("terrace"));
  }
}

}  // namespace
}  // namespace chromeball::scene_file_test
