// SPDX-License-Identifier: Apache-2.0
// Rotations and scales of probes from the command line and scene files; chromeball probe align.
#include <gtest/gtest.h>

#include <fstream>

#include "base/hash.h"
#include "base/json.h"
#include "front/arguments.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/irradiance.h"
#include "probe/probe.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_rotation_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

CommandResult run(const Words& arguments) {
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

// A triangle, a camera that looks along -Z, at the triangle or away from it; and probes.
class Turned : public testing::Test {
 protected:
  Turned() {
    writer_.add("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
    addTriangle(writer_);
    writer_.save();
    writeImage(probe_, map_);
    writeImage(sky_, clearSkyProbe({64, 32}, {}));
  }

  std::string path(const std::string& name) const { return (writer_.folder() / name).string(); }
  std::string scene(const std::string& probeKeys, bool seesTriangle = true) const {
    std::ofstream(path("scene.toml"))
        << "model = 'model.gltf'\n[camera]\nfov = 5\nlook_at = [0, 0, -10]\nposition = [0, 0, "
        << (seesTriangle ? "5" : "-5") << "]\n[probe]\nfile = 'probe.exr'\n"
        << probeKeys;
    return path("scene.toml");
  }
  // Shows only the background if `depth` is 0.
  Image render(const std::string& probeKeys, const Words& more = {}, int depth = 0) const {
    Words words{"render",      scene(probeKeys, depth > 0), "--size",  "16x12", "--samples",    "4",
                "--max-depth", std::to_string(depth),       "--quiet", "-o",    path("out.exr")};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
    return readImage(path("out.exr"));
  }
  static float difference(const Image& a, const Image& b) {
    float largest = 0;
    for (size_t i = 0; i < a.texels.size(); ++i)
      largest = std::max(largest, std::fabs(a.texels[i] - b.texels[i]));
    return largest;
  }

  GltfWriter writer_;
  const Image map_ = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.6, 0.5, 0.3});
  const std::string probe_ = path("probe.exr"), sky_ = path("sky.exr");
};

TEST_F(Turned, FilesAndOptionsTakeAnglesAndQuaternions) {
  const Image angles = render("rotation = [35, -50, 110]\n", {}, 2);
  EXPECT_EQ(angles.texels, render("", {"--probe-rotation", "35,-50,110"}, 2).texels);
  EXPECT_GT(difference(angles, render("", {"--probe-rotation", "35"}, 2)), 0.1f);
  const glm::dquat q = Rotation::ofAngles({35, -50, 110}).quaternion();
  const std::string text = fmt::format("{},{},{},{}", q.x, q.y, q.z, q.w);
  EXPECT_EQ(angles.texels, render("rotation = [" + text + "]\n", {}, 2).texels);
  EXPECT_EQ(angles.texels, render("", {"--probe-rotation", text}, 2).texels);
}

TEST_F(Turned, APitchAndRollOfZeroKeepTheBitsOfAYaw) {
  const Image yaw = render("rotation = 33.3\n", {}, 2);
  EXPECT_EQ(yaw.texels, render("rotation = [33.3, 0, 0]\n", {}, 2).texels);
}

// The camera looks along -Z: a pitch of 90 degrees lifts there the part of the map that was below.
TEST_F(Turned, TheCameraSeesTheTurnedProbe) {
  const Probe level(map_);
  const Image image = render("rotation = [0, 90, 0]\n");
  const Rgb expected = level.radiance(vec3(0, -1, 0));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(image.rgb(8, 6)[k], expected[k], 0.05f);
}

TEST_F(Turned, KeysOfTiltedRotationsTakeTheShortestWay) {
  const char* keys = "rotation_keys = [[0, 10], [2, [10, 0, 40]]]\n";
  const Image half = render(keys, {"--animation-time", "1"});
  EXPECT_LT(difference(half, render("rotation = [10, 0, 20]\n")), 1e-5f);
  EXPECT_EQ(render(keys, {"--animation-time", "5"}).texels,
            render("rotation = [10, 0, 40]\n").texels);
}

TEST_F(Turned, KeysWithoutAProbeAreNamed) {
  std::ofstream(path("lamp.toml"))
      << "model = 'model.gltf'\n[probe]\nrotation_keys = [[0, 10], [2, 20]]\n"
         "[[light]]\ndirection = [0, 0, 1]\nirradiance = 1\n";
  const Words words{"render", path("lamp.toml"), "--size", "4x3",          "--samples",
                    "2",      "--quiet",         "-o",     path("out.exr")};
  EXPECT_EQ(run(words).error, "chromeball: warning: " + path("lamp.toml") +
                                  ":3: `probe.rotation_keys` has no effect without a probe\n");
}

TEST_F(Turned, ScalesMayDifferByChannel) {
  const Image one = render(""), scaled = render("scale = [2, 1, 0.5]\n");
  EXPECT_EQ(scaled.texels, render("", {"--probe-scale", "2,1,0.5"}).texels);
  for (int y = 0; y < one.height; ++y)
    for (int x = 0; x < one.width; ++x)
      EXPECT_EQ(scaled.rgb(x, y), one.rgb(x, y) * Rgb(2, 1, 0.5f));
  run({"probe", "convert", probe_, path("c.exr"), "--to", "lat-long", "--scale", "2,1,0.5"});
  EXPECT_EQ(readImage(path("c.exr")).rgb(7, 9), map_.rgb(7, 9) * Rgb(2, 1, 0.5f));
}

TEST_F(Turned, CommandsTurnDirections) {
  const Rotation rotation = Rotation::ofAngles({20, 70, -35});
  const auto sunOf = [&](const Words& more) {
    Words words{"probe", "info", sky_, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const json d = parseJson(run(words).out)["suns"][0]["direction"];
    return vec3(d[0], d[1], d[2]);
  };
  const vec3 sun = sunOf({}), turned = rotation(sun);
  EXPECT_LT(glm::length(sunOf({"--rotation", "20,70,-35"}) - turned), 1e-5f);
  run({"lights", sky_, "--method", "suns", "--rotation", "20,70,-35", "-o", path("l.json")});
  const json light = jsonOfFile(path("l.json"))["lights"][0]["direction"];
  EXPECT_LT(glm::length(vec3(light[0], light[1], light[2]) - turned), 1e-5f);
  // The irradiance of the resampled probe against the turned one's.
  run({"probe", "edit", probe_, path("e.exr"), "--rotation", "20,70,-35"});
  run({"probe", "convert", probe_, path("c.exr"), "--to", "lat-long", "--rotation", "20,70,-35"});
  EXPECT_EQ(readImage(path("e.exr")).texels, readImage(path("c.exr")).texels);
  run({"probe", "irradiance", probe_, path("i.exr"), "--size", "8x4", "--rotation", "20,70,-35"});
  const Image irradiance = readImage(path("i.exr"));
  EXPECT_LT(difference(irradiance, irradianceMap(map_, {8, 4}, rotation)), 1e-5f);
  EXPECT_LT(difference(irradiance, irradianceMap(readImage(path("c.exr")), {8, 4})), 0.05f);
}

TEST_F(Turned, WrongRotationsAndScalesAreExplained) {
  const auto option = [&](const Words& more, const char* reason) {
    Words words{"render", scene("")};
    words.insert(words.end(), more.begin(), more.end());
    expectError(words, reason);
  };
  option({"--probe-rotation", "1,2"}, "`1,2` is not one angle, three (yaw, pitch, roll), or a");
  option({"--probe-rotation", "up"}, "`up` is not one angle");
  option({"--probe-rotation", "1,2,nan"}, "`nan` is not a finite number (degrees)");
  option({"--probe-rotation", "30,-5,2,0"},
         "--probe-rotation: the quaternion (30, -5, 2, 0) has the length 30.48; it should be 1");
  option({"--probe-scale", "1,2"}, "`1,2` is not a number, or three (r, g, b)");
  option({"--probe-scale", "1,-2,1"}, "`-2` is not a finite number, 0 or more");
  const auto file = [&](const std::string& keys, const char* reason) {
    expectError({"render", scene(keys)}, reason);
  };
  file("rotation = [1, 2]\n",
       "scene.toml:8: `rotation` must be one angle, three (yaw, pitch, roll)");
  file("rotation = [1, 2, 'x']\n", "`rotation` must be a finite number (degrees), not \"x\"");
  file("rotation = [0, 0, 0, 0]\n", "scene.toml:8: the quaternion (0, 0, 0, 0) has the length 0");
  file("scale = []\n", "`scale` must be a number, or three (r, g, b), not an array of 0");
  file("rotation_keys = [[0, 1], [1, [1, 2]]]\n", "`rotation_keys` must be one angle, three");
  file("rotation_keys = [[0, [1, 1, 1, 1]]]\n", "scene.toml:8: the quaternion (1, 1, 1, 1) has");
  file("rotation_keys = []\n", "`rotation_keys` must be ");
  expectError(
      {"probe", "convert", probe_, path("x.exr"), "--to", "lat-long", "--rotation", "1,2"},
      "--probe-rotation: `1,2` should be YAW or YAW,PITCH,ROLL in degrees, or a quaternion");
  expectError({"probe", "convert", probe_, path("x.exr"), "--to", "lat-long", "--scale", "1e39"},
              "--probe-scale: 1e39 should be not negative: 0, or 1.4e-45 to 3.4e38");
  expectError({"probe", "convert", probe_, path("x.exr"), "--to", "lat-long", "--scale", "3e38"},
              "a texel times the scale exceeds the range of a float");
  expectError({"lights", sky_, "--suggest", "1", "--rotation", "5", "-o", path("l.json")},
              "--probe-rotation: polygons are places in the probe's image; it turns lights");
}

TEST_F(Turned, AlignPrintsTheRotationAndWritesTheTurnedProbe) {
  const std::string studio = path("studio.exr"), turned = path("turned.exr");
  run({"probe", "synth", "studio", studio, "--size", "128x64"});
  run({"probe", "convert", studio, turned, "--to", "lat-long", "--rotation", "-20,15,30", "--scale",
       "3,2,1.5"});
  const std::string out = path("aligned.exr");
  const json found = parseJson(run({"probe", "align", turned, studio, "--json", "-o", out}).out);
  constexpr double kTexel = 360.0 / 128;
  const double error = found["standard_error"].get<double>();
  EXPECT_LT(error, 0.2 * kTexel);
  EXPECT_NEAR(found["yaw"].get<double>(), -20, 3 * error);
  EXPECT_NEAR(found["pitch"].get<double>(), 15, 3 * error);
  EXPECT_NEAR(found["roll"].get<double>(), 30, 3 * error);
  EXPECT_GT(found["correlation"].get<double>(), 0.98);
  EXPECT_FALSE(found["ambiguous"].get<bool>());
  EXPECT_TRUE(found["agrees"].get<bool>());
  EXPECT_EQ(found["quaternion"].size(), 4u);
  const json again = parseJson(run({"probe", "align", turned, out, "--json"}).out);
  EXPECT_NEAR(std::fabs(again["quaternion"][3].get<double>()), 1, 1e-5);
  const CommandResult text = run({"probe", "align", turned, studio});
  EXPECT_NE(text.out.find("rotation         yaw -"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("standard error   "), std::string::npos) << text.out;
  EXPECT_EQ(text.error, "");
}

class SlowTurned : public Turned {};

// Both are bright above and dark below, and have nothing else in common.
TEST_F(SlowTurned, AlignFindsNoAgreementOfDifferentPlaces) {
  const auto place = [&](const std::string& name, uint64_t seed) {
    const Image probe = colorImage(64, 32, [&](int x, int y) {
      const float patch = toUnit(uint32_t(hash(uint64_t(y / 4 * 16 + x / 4), seed)));
      return Rgb((y < 16 ? 1.0f : 0.3f) * std::exp(2.5f * patch));
    });
    writeImage(path(name), probe);
    return path(name);
  };
  const std::string a = place("a.exr", 1), b = place("b.exr", 2);
  const CommandResult result = run({"probe", "align", a, b, "--json"});
  EXPECT_NE(result.error.find("warning: found no agreement: the correlation is 0."),
            std::string::npos)
      << result.error;
  const json found = parseJson(result.out);
  EXPECT_FALSE(found["agrees"].get<bool>());
}

TEST_F(Turned, AlignSaysWhatItCannotTell) {
  const std::string overcast = path("overcast.exr"), constant = path("constant.exr");
  run({"probe", "synth", "overcast", overcast, "--size", "64x32"});
  run({"probe", "synth", "constant", constant, "--size", "64x32"});
  const CommandResult sky = run({"probe", "align", overcast, overcast});
  EXPECT_NE(sky.error.find("warning: ambiguous: "), std::string::npos) << sky.error;
  EXPECT_NE(sky.error.find("all turned about the axis ("), std::string::npos) << sky.error;
  const CommandResult flat = runCommand({"probe", "align", overcast, constant});
  EXPECT_EQ(flat.status, 2);
  EXPECT_NE(flat.error.find("constant.exr: has the same radiance in all"), std::string::npos);
  expectError({"probe", "align", overcast, path("none.exr")}, "none.exr");
  expectError({"probe", "align", overcast, sky_, "-o", sky_}, "sky.exr");
}

}  // namespace
}  // namespace chromeball::command_rotation_test
