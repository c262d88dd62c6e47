// SPDX-License-Identifier: Apache-2.0
// Messages of the command: typing errors, options of other renderers, warnings, notes.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_message_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

class SlowCommandMessage : public testing::Test {
 protected:
  SlowCommandMessage() {
    addTriangle(w_);
    w_.add(
        "cameras",
        {{"type", "perspective"}, {"name", "Lens"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    w_.add("nodes", {{"name", "Tripod"}, {"camera", 0}, {"translation", {0, 0, 3}}});
    w_.root["scenes"] = {{{"nodes", {0, 1}}}};
    w_.root["scene"] = 0;
    writeImage(folder_ / "probe.exr", constantProbe({8, 4}, Rgb(1)));
  }

  CommandResult render(const Words& more, const std::string& output = "a.exr") {
    Words words{"render",    w_.save(), "--probe", folder_ / "probe.exr", "--size", "4x4",
                "--samples", "2",       "-o",      folder_ / output};
    words.insert(words.end(), more.begin(), more.end());
    return runCommand(words);
  }

  GltfWriter w_;
  TemporaryFolder folder_;
};

TEST(CommandMessage, TextThatCannotBeWrittenIsAFailure) {
  const TemporaryFolder folder;
  for (const char* words : {"--help", "--version", "render --help", "probe synth --help"}) {
    const std::string error = folder / "error",
                      line = std::string(kCommand) + " " + words + " >/dev/full 2>" + error;
    const int status = std::system(line.c_str());
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 1) << words;
    EXPECT_EQ(fileContents(error).find("chromeball: standard output: "), 0u) << words;
  }
}

// The file is the same, and so is the status, on full disks, closed streams and pipes that nobody
// reads. A closed stream's number must not become that of the file.
TEST_F(SlowCommandMessage, OneThatCannotBeWrittenIsLostAndTheWorkGoesOn) {
  const std::string model = w_.save(), image = folder_ / "a.pfm", left = folder_ / "status";
  const auto statusOf = [&](const std::string& words, const std::string& streams) {
    std::filesystem::remove(image), std::filesystem::remove(left);
    const std::string line =
        fmt::format("(sleep 0.1; {} {}; echo $? >{}) {}", kCommand, words, left, streams);
    EXPECT_EQ(std::system(line.c_str()), 0);
    return fileContents(left);
  };
  const std::string render = fmt::format("render {} --probe {} --size 4x4 --samples 2 -o {}", model,
                                         folder_ / "probe.exr", image);
  ASSERT_EQ(statusOf(render, ">/dev/null 2>&1"), "0\n");
  const std::string whole = fileContents(image);
  for (const char* streams : {">/dev/null 2>/dev/full", ">/dev/null 2>&-", "<&- >/dev/null 2>&-",
                              "2>&1 >/dev/null | :"}) {
    EXPECT_EQ(statusOf(render, streams), "0\n") << streams;
    EXPECT_EQ(fileContents(image), whole) << streams;
    EXPECT_EQ(statusOf("probe info " + (folder_ / "probe.exr"), streams), "0\n") << streams;
    EXPECT_EQ(statusOf("render " + (folder_ / "none.gltf"), streams), "2\n") << streams;
  }
  for (const char* streams : {">&- 2>&-", ">/dev/full 2>/dev/full"}) {
    EXPECT_EQ(statusOf(render, streams), "1\n") << streams;
    EXPECT_EQ(fileContents(image), whole) << streams;
  }
}

TEST_F(SlowCommandMessage, OptionsOfOtherRenderersGetASuggestion) {
  for (const auto& [theirs, ours] :
       std::vector<std::pair<std::string, std::string>>{{"--spp", "--samples"},
                                                        {"--output-file", "--output"},
                                                        {"--width", "--size"},
                                                        {"--height", "--size"},
                                                        {"--resolution", "--size"},
                                                        {"--envmap", "--probe"},
                                                        {"--hdri", "--probe"},
                                                        {"-s", "--samples"},
                                                        {"--bounces", "--max-depth"},
                                                        {"--spp=16", "--samples"},
                                                        {"--sampels", "--samples"},
                                                        {"-t", "--threads"}}) {
    const CommandResult result = runCommand({"render", w_.save(), theirs, "16"});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.error.find("did you mean `" + ours), std::string::npos) << result.error;
  }
}

TEST_F(SlowCommandMessage, InvalidNumbersAreQuoted) {
  EXPECT_EQ(render({"--noise", "30%"}).status, 0);
  for (const char* noise : {"1e-320", "4.9e-324"})
    EXPECT_EQ(render({"--noise", noise}).status, 0) << noise;
  const auto expectInputError = [&](const Words& words, const char* reason) {
    Words all{"render", w_.save()};
    all.insert(all.end(), words.begin(), words.end());
    expectError(all, reason);
  };
  expectInputError({"--noise", "much"}, "--noise: `much` is not a finite number above 0");
  expectInputError({"--samples", "many"}, "--samples: `many` is not a whole number from 1 to");
  expectInputError({"--samples", "1.5"}, "--samples: `1.5` is not a whole number from 1 to");
  expectInputError({"--seed", "-1"}, "--seed: `-1` is not a whole number, 0 or more");
}

// In decimal, in all commands, whether they are settings or not.
TEST_F(SlowCommandMessage, NumbersAreReadAlike) {
  const std::string probe = folder_ / "probe.exr", out = folder_ / "out";
  for (const char* number : {"0x10", "1e", " 5", "5 ", "true", "5s", "--5", "0b1"}) {
    const std::string quoted = fmt::format("`{}` is not a", number);
    const auto value = [&](const char* option) { return fmt::format("{}={}", option, number); };
    expectError({"render", w_.save(), value("--samples")}, quoted);
    expectError({"compare", w_.save(), value("--samples"), "-o", out}, quoted);
    expectError({"compare", w_.save(), value("--repeats"), "-o", out}, quoted);
    expectError({"compare", w_.save(), value("--times"), "-o", out}, quoted);
    expectError({"image", "view", probe, out + ".png", value("--exposure")}, quoted);
    expectError({"basis", w_.save(), "-o", out + ".glb", value("--clusters")}, quoted);
  }
  // Not octal; the first is refused for its range.
  expectError({"basis", w_.save(), "-o", out + ".glb", "--vectors", "0257"}, "from 0 to 256");
  EXPECT_EQ(runCommand({"image", "view", probe, out + ".png", "--exposure", "+1e-60"}).status, 0);
}

TEST_F(SlowCommandMessage, OptionsTakeOneValue) {
  expectError({"render", w_.save(), "--samples"}, "--samples: needs a value, N");
}

TEST_F(SlowCommandMessage, WarnsAboutSettingsWithoutEffect) {
  for (const char* output : {"a.exr", "a.hdr", "a.pfm"}) {
    const std::string messages = render({"--tonemap", "aces", "--exposure", "1"}, output).error;
    for (const char* option : {"--tonemap", "--exposure"})
      EXPECT_NE(messages.find(std::string("warning: ") + option + " has no effect"),
                std::string::npos);
  }
  EXPECT_EQ(render({"--tonemap", "aces", "--exposure", "1"}, "a.png").error.find("no effect"),
            std::string::npos);
  EXPECT_EQ(render({}).error.find("warning"), std::string::npos);
  EXPECT_NE(render({"--sun-angle", "1"}).error.find("warning: --sun-angle has no effect"),
            std::string::npos);
  const auto effect = [&](const Words& more) {
    Words words{"render",    w_.save(), "--sun-angle", "1",   "--strategy", "suns",
                "--samples", "1",       "--size",      "4x4", "-o",         folder_ / "a.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return runCommand(words).error.find("no effect") == std::string::npos;
  };
  const std::string noon = std::string(kSourceDir) + "/probes/noon.exr";
  EXPECT_TRUE(effect({"--probe", noon}));
  EXPECT_TRUE(effect({"--probe", noon, "--light-from", "suns"}));
  EXPECT_FALSE(effect({"--probe", noon, "--light-from", "rest"}));
  EXPECT_FALSE(effect({"--probe", folder_ / "probe.exr"}));  // without suns
  EXPECT_NE(render({"--aov", "albedo"}, "a.png").error.find("warning: --aov has no effect"),
            std::string::npos);
  EXPECT_EQ(render({"--aov", "albedo"}, "a.exr").error.find("warning"), std::string::npos);
}

TEST_F(SlowCommandMessage, NamesTheProbesScaleAsTheCauseOfABlackImage) {
  const CommandResult r = render({"--probe-scale", "0"});
  EXPECT_EQ(r.status, 0);
  EXPECT_NE(r.error.find("--probe-scale 0 turns the probe off"), std::string::npos) << r.error;
  EXPECT_EQ(render({}).error.find("are black"), std::string::npos);
}

// A lamp lights what the probe, far brighter, does not reach: its sun is behind the triangle.
TEST_F(SlowCommandMessage, CallsNoPictureBlackThatALampLights) {
  Image sun(32, 16, 3);
  sun.setRgb(16, 8, Rgb(1e9f));
  writeImage(folder_ / "sun.exr", sun);
  const auto messages = [&](const std::string& lamp) {
    std::ofstream(folder_ / "s.toml")
        << "model = '" << w_.save() << "'\n[probe]\nfile = 'sun.exr'\nmapping = 'lat-long'\n"
        << "[camera]\nposition = [0.3, 0.3, 1]\nlook_at = [0.3, 0.3, 0]\nfov = 20\n"
        << lamp;
    const Words words{"render", folder_ / "s.toml", "--size", "4x4", "--samples", "16",
                      "-o",     folder_ / "a.exr"};
    return runCommand(words).error;
  };
  const std::string lamp = "[[light]]\ntype = 'point'\nposition = [0.3, 0.3, 1]\nintensity = 1\n";
  EXPECT_NE(messages("").find("are black"), std::string::npos);
  EXPECT_EQ(messages(lamp).find("are black"), std::string::npos) << messages(lamp);
}

// Each time there is light, until a setting takes it.
TEST_F(SlowCommandMessage, NamesWhatTookTheLightOfABlackImage) {
  const auto expectNamed = [&](const Words& given, const std::string& names,
                               const std::string& scene = "") {
    std::ofstream(folder_ / "s.toml")
        << "model = '" << w_.save() << "'\n[camera]\nposition = [0.3, 0.3, 1]\n"
        << "look_at = [0.3, 0.3, 0]\nfov = 20\n"
        << scene;
    Words words{"render", folder_ / "s.toml", "--size", "4x4", "--samples", "16",
                "-o",     folder_ / "a.exr"};
    if (scene.empty()) words.insert(words.end(), {"--probe", folder_ / "probe.exr"});
    EXPECT_EQ(runCommand(words).error.find("are black"), std::string::npos);
    words.insert(words.end(), given.begin(), given.end());
    const std::string error = runCommand(words).error;
    EXPECT_NE(error.find("no light reaches them with " + names), std::string::npos)
        << names << ": " << error;
    EXPECT_EQ(error.find("[[light]]"), std::string::npos) << error;
  };
  w_.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  w_.root["meshes"][0]["primitives"][0]["material"] = 0;
  const std::string depth = "--max-diffuse-depth 0; leave it out";
  expectNamed({"--max-diffuse-depth", "0"}, depth);
  expectNamed({"--max-diffuse-depth", "0", "--integrator", "direct"}, depth);
  expectNamed({"--max-diffuse-depth", "0", "--max-specular-depth", "0"}, depth);
  expectNamed({"--clamp", "1e-7"}, "--clamp 1e-07; leave it out");
  const std::string lamp = "[[light]]\ntype = 'point'\nposition = [0.3, 0.3, 1]\nintensity = 1\n";
  const std::string sun = "[[light]]\ntype = 'sun'\nirradiance = 1\ndirection = ";
  expectNamed({"--light-from", "suns"}, "--light-from suns; leave it out",
              lamp + sun + "[0, 0, -1]\n");
  expectNamed({"--light-from", "rest"}, "--light-from rest; leave it out", sun + "[0, 0, 1]\n");
}

// Lamps would not help.
TEST_F(SlowCommandMessage, NamesMaterialsThatReflectNothing) {
  const json black = {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 0}};
  w_.add("materials", {{"pbrMetallicRoughness", black},
                       {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  w_.add("materials", {{"pbrMetallicRoughness", black},
                       {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  w_.add("materials", {{"pbrMetallicRoughness", black}});  // shines by its surface
  for (const int material : {0, 1, 2}) {
    w_.root["meshes"][0]["primitives"][0]["material"] = material;
    const std::string error = render({}).error;
    EXPECT_EQ(error.find("are black: their materials reflect nothing") != std::string::npos,
              material < 2)
        << error;
    EXPECT_EQ(error.find("[[light]]"), std::string::npos) << error;
  }
}

TEST_F(SlowCommandMessage, WarnsAboutASquareProbeReadAsLatLong) {
  const auto messages = [&](ImageSize size, const char* mapping) {
    writeImage(folder_ / "probe.exr", constantProbe(size, Rgb(1)));
    return render({"--probe-mapping", mapping}).error;
  };
  EXPECT_NE(
      messages({8, 8}, "lat-long").find("warning: " + (folder_ / "probe.exr") + ": is square"),
      std::string::npos);
  EXPECT_EQ(messages({8, 8}, "angular").find("is square"), std::string::npos);
  EXPECT_EQ(messages({8, 4}, "lat-long").find("warning"), std::string::npos);
}

TEST_F(SlowCommandMessage, WarnsAboutAnAngleThatLooksLikeRadians) {
  const auto messages = [&](const char* fov) {
    w_.save();
    const std::string scene = (w_.folder() / "scene.toml").string();
    std::ofstream(scene)
        << "model = 'model.gltf'\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, "
           "0]\nfov = "
        << fov << "\n[probe]\nfile = '" << folder_ / "probe.exr"
        << "'\n";
    return runCommand({"render", scene, "--size", "4x4", "--samples", "1", "--quiet", "-o",
                       folder_ / "a.exr"})
        .error;
  };
  EXPECT_NE(messages("0.6").find("scene.toml:5: `fov` is in degrees"), std::string::npos)
      << messages("0.6");
  EXPECT_NE(messages("0.6").find("34.4 degrees"), std::string::npos) << messages("0.6");
  EXPECT_EQ(messages("4"), "");
}

TEST_F(SlowCommandMessage, QuietHidesNotesButNotWarnings) {
  w_.root["animations"] = {
      {{"name", "Wave"}, {"channels", json::array()}, {"samplers", json::array()}}};
  w_.root["extensionsUsed"] = {"KHR_unheard_of"};
  const CommandResult loud = render({}), quiet = render({"--quiet"});
  EXPECT_NE(loud.error.find("chromeball: " + (w_.folder() / "model.gltf").string() +
                            ": shown in its rest pose"),
            std::string::npos)
      << loud.error;
  EXPECT_NE(loud.error.find("`Wave`"), std::string::npos) << "the names of the animations";
  EXPECT_NE(loud.error.find("detected as a lat-long probe because its shape is 2:1"),
            std::string::npos)
      << loud.error;
  EXPECT_EQ(quiet.out, "");
  ASSERT_EQ(std::count(quiet.error.begin(), quiet.error.end(), '\n'), 1) << quiet.error;
  EXPECT_TRUE(quiet.error.starts_with("chromeball: warning: ")) << quiet.error;
  EXPECT_NE(quiet.error.find("KHR_unheard_of"), std::string::npos);
}

TEST_F(SlowCommandMessage, CamerasAreFoundByCameraOrNodeName) {
  EXPECT_EQ(render({"--camera", "Lens"}).status, 0);
  EXPECT_EQ(render({"--camera", "Tripod"}).status, 0);
  const CommandResult none = render({"--camera", "Tripot"});
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.error.find("did you mean `Tripod`?"), std::string::npos) << none.error;
}

// The value of an option that may be left out is behind `=`, wherever the option is.
TEST_F(SlowCommandMessage, ValuesThatNeedAnEqualsSignAreRecognised) {
  const std::string model = w_.save();
  expectError({"render", model, "--ground", "0.5"}, "did you mean `--ground=0.5`?");
  expectError({"render", "--ground", "-2", model}, "did you mean `--ground=-2`?");
  EXPECT_EQ(render({"--ground=-2"}).status, 0);
}

TEST_F(SlowCommandMessage, TheCameraThatWasTakenIsNamed) {
  const auto seen = [&](const Words& more) { return render(more).error; };
  const std::string own = ": seen by its camera `Lens`\n";
  EXPECT_NE(seen({}).find(own), std::string::npos) << seen({});
  for (const Words& given : {Words{"--camera", "Lens"}, {"--view", "20,10"}, {"--quiet"}})
    EXPECT_EQ(seen(given).find("seen "), std::string::npos) << given.front();
  w_.root["cameras"].push_back(w_.root["cameras"][0]);
  w_.add("nodes", {{"camera", 1}});
  w_.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
  EXPECT_NE(seen({}).find("`Lens`, the first of 2; see --camera NAME"), std::string::npos)
      << seen({});
  w_.root["scenes"] = {{{"nodes", {0}}}};
  // The same angles and field of view give the same picture.
  const std::string chosen = seen({});
  const size_t at = chosen.find("seen from azimuth ");
  ASSERT_NE(at, std::string::npos) << chosen;
  double azimuth = 0, elevation = 0, fov = 0;
  ASSERT_EQ(std::sscanf(chosen.c_str() + at,
                        "seen from azimuth %lf and elevation %lf, with a field of view of %lf",
                        &azimuth, &elevation, &fov),
            3);
  const Image found = readImage(folder_ / "a.exr");
  render({"--view", fmt::format("{},{}", azimuth, elevation), "--fov", fmt::format("{}", fov)});
  const Image again = readImage(folder_ / "a.exr");
  for (size_t i = 0; i < found.texels.size(); ++i)
    EXPECT_NEAR(found.texels[i], again.texels[i], 0.01f);
}

TEST_F(SlowCommandMessage, SmallLimitsOfNoiseArePercent) {
  EXPECT_NE(render({"--noise", "0.02"}).error.find("--noise: 0.02% of noise, not 2%"),
            std::string::npos);
  EXPECT_EQ(render({"--noise", "0.05"}).error.find("of noise"), std::string::npos);
}

}  // namespace
}  // namespace chromeball::command_message_test
