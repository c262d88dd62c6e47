// SPDX-License-Identifier: Apache-2.0
// How a .png is exposed: by its surfaces, by a number, and alike for all parts of a job.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "front/plan_render.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "run_command.h"
#include "small_model.h"

#include <fmt/ranges.h>

namespace chromeball::exposure_test {
namespace {

using Words = std::vector<std::string>;

Image grey(int width, int height, float radiance) {
  Image image(width, height, 3);
  std::ranges::fill(image.texels, radiance);
  return image;
}

// The mean becomes 0.25, by steps of a tenth of a stop.
TEST(AutoExposure, ScalesWithThePicture) {
  for (const float radiance : {1e-6f, 0.25f, 3.f, 1e6f})
    EXPECT_NEAR(autoExposure(grey(40, 30, radiance)), std::log2(0.25f / radiance), 0.0501f)
        << radiance;
  const float stops = autoExposure(grey(4, 4, 0.1f));
  EXPECT_FLOAT_EQ(stops, std::round(10 * stops) / 10);
}

TEST(AutoExposure, FewPixelsDecideNothing) {
  const Image plain = grey(100, 10, 0.25f);
  for (const float odd : {0.f, -1.f, 1e30f, std::numeric_limits<float>::infinity(),
                          std::numeric_limits<float>::quiet_NaN()}) {
    Image image = plain;
    for (size_t i = 0; i < 10; ++i) image.setRgb(97 * i, Rgb(odd));
    EXPECT_EQ(autoExposure(image), 0) << odd;
  }
}

// Of what is bright or saturated no more than a twentieth clips.
TEST(AutoExposure, KeepsHighlights) {
  Image image = grey(10, 10, 0.02f);
  for (size_t i = 0; i < 10; ++i) image.setRgb(i, Rgb(0.1f, 0.2f, 0.1f));
  const float stops = std::log2(1 / 0.2f);
  EXPECT_NEAR(autoExposure(grey(10, 10, 0.02f)), std::log2(0.25f / 0.02f), 0.0501f);
  EXPECT_NEAR(autoExposure(image), stops, 0.0501f);
}

// A patch of sun does not turn a room black, but a picture of much light is not burnt.
TEST(AutoExposure, GivesUpALittleForHighlights) {
  const auto withBright = [](size_t count) {
    Image image = grey(10, 10, 0.01f);
    for (size_t i = 0; i < count; ++i) image.setRgb(i, Rgb(8));
    return image;
  };
  EXPECT_NEAR(autoExposure(withBright(10)),
              std::log2(0.25f / 0.01f) - 0.1f * std::log2(800.0f) * 1.02f - 1.5f, 0.2f);
  EXPECT_EQ(autoExposure(withBright(40)), -3);
}

TEST(AutoExposure, LooksAtSurfaces) {
  Image image = grey(10, 10, 0.25f), coverage(10, 10, 1);
  for (size_t i = 50; i < 100; ++i) image.setRgb(i, Rgb(4096));
  for (size_t i = 0; i < 50; ++i) *coverage.at(i) = 1;
  EXPECT_EQ(autoExposure(image, coverage), 0);
  EXPECT_LT(autoExposure(image), -10);
  EXPECT_EQ(autoExposure(image, Image(10, 10, 1)), autoExposure(image)) << "nothing is hit";
  EXPECT_EQ(autoExposure(grey(4, 4, 0)), 0) << "all is black";
}

TEST(WhiteBalance, MakesTheLightWhite) {
  const Rgb light(0.9f, 0.5f, 0.2f), shown = display({.balance = balanceOf(light)}, light);
  EXPECT_NEAR(shown.x, luminance(light), 1e-6f);
  EXPECT_NEAR(shown.y, shown.x, 1e-6f);
  EXPECT_NEAR(shown.z, shown.x, 1e-6f);
}

// Standard illuminant A, a black body of 2856 K, has the chromaticity 0.44757, 0.40745, and one of
// 6504 K, which stays, 0.3135, 0.3237; these are their linear Rec. 709 colours.
TEST(WhiteBalance, OfATemperature) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(balanceOf(6504.)[c], 1, 1e-5);
  const Rgb a(1.845f, 0.826f, 0.233f), white(1.0425f, 0.984f, 1.035f);
  const Rgb shown = a * balanceOf(2856.);
  EXPECT_NEAR(shown.x / shown.y, white.x / white.y, 0.02);
  EXPECT_NEAR(shown.z / shown.y, white.z / white.y, 0.02);
}

class Exposure : public testing::Test {
 protected:
  Exposure() {
    writeSmallModel(folder_ / "m.gltf");
    writeImage(folder_ / "probe.pfm", grey(8, 4, 12));
  }
  CommandResult render(Words more) const {
    Words words{"render", folder_ / "m.gltf", "--probe", folder_ / "probe.pfm", "--size",
                "48x32",  "--samples",        "8"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  static CommandResult run(const Words& words) {
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result;
  }
  // "-3.2" of "exposure -3.2 stops (auto)", or from another source
  static std::string stopsIn(const std::string& out) {
    const size_t begin = out.find("exposure ");
    if (begin == std::string::npos || out.find(" stops (") == std::string::npos) return "";
    return out.substr(begin + 9, out.find(" stops") - begin - 9);
  }
  std::string bytes(const std::string& name) const { return fileContents(folder_ / name); }

  const TemporaryFolder folder_;
};

TEST_F(Exposure, IsPrintedStoredAndRepeatable) {
  const std::string stops = stopsIn(render({"-o", folder_ / "a.png", "-o", folder_ / "a.exr"}).out);
  ASSERT_NE(stops, "");
  EXPECT_LT(std::stof(stops), -2) << "the probe is bright";
  EXPECT_EQ(float(*metadataNumber(readExrMetadata(folder_ / "a.exr"), "exposure")),
            std::stof(stops));
  EXPECT_EQ(stopsIn(render({"-o", folder_ / "b.png", "--exposure", stops}).out), "");
  EXPECT_TRUE(bytes("a.png") == bytes("b.png"));
  EXPECT_NE(bytes("a.png").find("exposure"), std::string::npos) << "tEXt";
  render({"-o", folder_ / "c.png", "--exposure", "auto", "--threads", "1", "--quiet"});
  EXPECT_TRUE(bytes("a.png") == bytes("c.png"));
  const std::string shown = run({"image", "view", folder_ / "a.exr", folder_ / "v.png"}).out;
  EXPECT_EQ(stopsIn(shown), stops);
  EXPECT_NE(shown.find("stops (from the header)"), std::string::npos) << shown;
  EXPECT_TRUE(bytes("a.png") == bytes("v.png"));
}

TEST_F(Exposure, IsTheSameForAllSeeds) {
  Image sky = grey(32, 16, 1);
  sky.setRgb(5, 2, Rgb(1e4f));
  writeImage(folder_ / "probe.pfm", sky);
  std::set<std::string> found;
  for (const char* seed : {"0", "1", "2", "3", "4", "5", "6", "7"})
    found.insert(stopsIn(
        render({"--seed", seed, "--size", "6x4", "--samples", "1", "-o", folder_ / "a.png"}).out));
  EXPECT_EQ(found.size(), 1u) << fmt::format("{}", fmt::join(found, ", "));
}

TEST_F(Exposure, ZeroIsRadiance) {
  render({"-o", folder_ / "a.png", "-o", folder_ / "a.exr", "--exposure", "0"});
  const Image png = readImage(folder_ / "a.png"), exr = readImage(folder_ / "a.exr");
  for (size_t i = 0; i < png.texels.size(); ++i)
    EXPECT_NEAR(png.texels[i], std::min(exr.texels[i], 1.f), 0.01f);
  EXPECT_EQ(bytes("a.png").find("exposure"), std::string::npos);
}

TEST_F(Exposure, IsNotMeasuredForRadiance) {
  EXPECT_EQ(stopsIn(render({"-o", folder_ / "a.exr"}).out), "");
  EXPECT_FALSE(metadataNumber(readExrMetadata(folder_ / "a.exr"), "exposure"));
}

// All parts of a render find the same, also one that sees nothing but sky, and their whole has it.
TEST_F(Exposure, OfPartsIsThatOfTheWhole) {
  Image sky = grey(8, 4, 12);
  for (size_t i = 16; i < 32; ++i) sky.setRgb(i, Rgb(0.1f));
  writeImage(folder_ / "probe.pfm", sky);
  const std::string whole = stopsIn(render({"--guide", "off", "-o", folder_ / "a.png"}).out);
  const auto part = [&](const std::string& crop, const std::string& name) {
    return stopsIn(render({"--guide", "off", "--crop", crop, "-o", folder_ / name}).out);
  };
  EXPECT_EQ(part("0,0,48,2", "top.exr"), whole);
  EXPECT_EQ(part("0,2,48,30", "rest.exr"), whole);
  const auto merge = [&](Words more) {
    Words words{"merge", folder_ / "top.exr", folder_ / "rest.exr"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words).out;
  };
  const std::string merged = merge({"-o", folder_ / "m.png"});
  EXPECT_EQ(stopsIn(merged), whole);
  EXPECT_NE(merged.find("stops (from the parts)"), std::string::npos) << merged;
  EXPECT_TRUE(bytes("m.png") == bytes("a.png"));
  EXPECT_EQ(stopsIn(merge({"-o", folder_ / "z.png", "--exposure", "0", "--tonemap", "aces"})), "");
  render({"--guide", "off", "-o", folder_ / "b.png", "--exposure", "0", "--tonemap", "aces"});
  EXPECT_TRUE(bytes("z.png") == bytes("b.png"));
}

// A checkpoint is a part.
TEST_F(Exposure, OfACheckpointIsThatOfTheRender) {
  render({"-o", folder_ / "a.png"});
  for (const Words& more : {Words{}, Words{"--denoise"}}) {
    Words words{"--checkpoint", folder_ / "c.exr", "-o", folder_ / "a.exr"};
    words.insert(words.end(), more.begin(), more.end());
    render(words);
    const std::string merged =
        run({"merge", folder_ / "c.exr", "-o", folder_ / "m.png", "-o", folder_ / "m.exr"}).out;
    EXPECT_NE(stopsIn(merged), "") << merged;
    const Metadata header = readExrMetadata(folder_ / "m.exr");
    EXPECT_EQ(header.contains("denoise"), !more.empty());
    if (header.contains("denoise")) {
      EXPECT_EQ(std::get<std::string>(header.at("denoise")), "true");
    }
    EXPECT_EQ(bytes("m.png") == bytes("a.png"), more.empty());
    std::filesystem::remove(folder_ / "c.exr");
  }
  const CommandResult given =
      render({"--checkpoint", folder_ / "c.exr", "-o", folder_ / "b.exr", "--exposure", "2"});
  EXPECT_EQ(given.error.find("no effect"), std::string::npos) << given.error;
}

TEST_F(Exposure, MergeSaysWhatNeedsAPng) {
  render({"--guide", "off", "--crop", "0,0,48,32", "-o", folder_ / "all.exr"});
  const auto errorOf = [&](const std::string& output, Words more) {
    Words words{"merge", folder_ / "all.exr", "-o", folder_ / output};
    words.insert(words.end(), more.begin(), more.end());
    return run(words).error;
  };
  const auto isNamed = [](const std::string& error, const std::string& option) {
    return error.find(option + " has no effect: it is for .png") != std::string::npos;
  };
  for (const char* option : {"--exposure", "--tonemap", "--white-balance"}) {
    const std::string name = option;
    const Words given{name, name == "--tonemap" ? "aces" : name == "--exposure" ? "2" : "3000"};
    EXPECT_TRUE(isNamed(errorOf("m.hdr", given), option)) << option;
    EXPECT_FALSE(isNamed(errorOf("m.png", given), option)) << option;
    EXPECT_EQ(isNamed(errorOf("m.exr", given), option), name != "--exposure");
  }
}

// It has no plate whose white it must share.
TEST_F(Exposure, OfAShadowCatcherFollowsItsLight) {
  const Words catcher{"--shadow-catcher", "ground", "-o", folder_ / "a.png"};
  const std::string bright = stopsIn(render(catcher).out);
  writeImage(folder_ / "probe.pfm", grey(8, 4, 12.f / 256));
  const std::string dim = stopsIn(render(catcher).out);
  ASSERT_NE(bright, "");
  ASSERT_NE(dim, "");
  EXPECT_NEAR(std::stof(dim), std::stof(bright) + 8, 1e-3);
  const auto part = [&](const std::string& crop, const std::string& name) {
    render({"--shadow-catcher", "ground", "--guide", "off", "--crop", crop, "-o", folder_ / name});
  };
  part("0,0,48,9", "top.exr");
  part("0,9,48,23", "rest.exr");
  EXPECT_EQ(
      stopsIn(
          run({"merge", folder_ / "top.exr", folder_ / "rest.exr", "-o", folder_ / "m.png"}).out),
      dim);
}

TEST_F(Exposure, OfASequenceIsThatOfItsFirstFrame) {
  writeImage(folder_ / "p.0.pfm", grey(8, 4, 12));
  writeImage(folder_ / "p.1.pfm", grey(8, 4, 1));
  const Words frames{"render",
                     folder_ / "m.gltf",
                     "--probe-sequence",
                     folder_ / "p.#.pfm",
                     "--size",
                     "48x32",
                     "--samples",
                     "8",
                     "--frames",
                     "0:1",
                     "-o",
                     folder_ / "f.#.png"};
  const CommandResult all = run(frames);
  EXPECT_NE(all.out.find("auto"), all.out.rfind("auto")) << "both say it";
  run({"render", folder_ / "m.gltf", "--probe", folder_ / "p.1.pfm", "--size", "48x32", "--samples",
       "8", "-o", folder_ / "second.png", "--exposure", stopsIn(all.out)});
  const std::string second = bytes("second.png");
  EXPECT_TRUE(bytes("f.1.png") == second) << "as bright as by the first frame's probe";
  std::filesystem::remove(folder_ / "f.1.png");
  EXPECT_EQ(stopsIn(run(frames).out), stopsIn(all.out)) << "frame 0 exists";
  EXPECT_TRUE(bytes("f.1.png") == second);
  std::filesystem::remove(folder_ / "f.1.png");
  Words one = frames;
  one.insert(one.end(), {"--frame", "1"});
  run(one);
  EXPECT_TRUE(bytes("f.1.png") == second);
}

TEST_F(Exposure, IsAKeyOfTheSceneFile) {
  const auto pictureOf = [&](const std::string& keys) {
    std::ofstream(folder_ / "s.toml")
        << "model = \"m.gltf\"\nprobe = { file = \"probe.pfm\" }\n"
        << "render = { size = [48, 32], samples = 8 }\n[output]\nfile = \"s.png\"\n" + keys;
    run({"render", folder_ / "s.toml"});
    return bytes("s.png");
  };
  render({"-o", folder_ / "a.png", "--exposure", "-4.5", "--tonemap", "filmic", "--white-balance",
          "3200"});
  EXPECT_EQ(pictureOf("exposure = -4.5\ntonemap = \"filmic\"\nwhite_balance = 3200\n"),
            bytes("a.png"));
  render({"-o", folder_ / "a.png"});
  EXPECT_EQ(pictureOf("exposure = \"auto\"\n"), bytes("a.png"));
  std::ofstream(folder_ / "bad.toml") << "model = \"m.gltf\"\n[output]\nexposure = \"bright\"\n";
  expectError({"render", folder_ / "bad.toml"}, "bad.toml:3");
}

TEST_F(Exposure, OfAFileIsBySurfacesIfItTells) {
  Image color = grey(8, 8, 0.25f), depth(8, 8, 1);
  for (size_t i = 0; i < 64; ++i) *depth.at(i) = i < 32 ? 2 : INFINITY;
  for (size_t i = 32; i < 64; ++i) color.setRgb(i, Rgb(300));
  writeImage(folder_ / "sky.exr",
             OutputImage{{{"", "RGB", color}, {"depth", "", depth}}, {}, {}, {}});
  const auto view = [&](const Words& more) {
    Words words{"image", "view", folder_ / "sky.exr", folder_ / "v.png"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words).out;
  };
  EXPECT_EQ(stopsIn(view({})), "+0.0");
  EXPECT_EQ(stopsIn(view({"--layer", "depth"})), "");
  EXPECT_EQ(
      stopsIn(run({"image", "develop", folder_ / "sky.exr", folder_ / "d.png", "--clip", "1"}).out),
      "+0.0");
  EXPECT_EQ(stopsIn(run({"image", "develop", folder_ / "sky.exr", folder_ / "d.exr"}).out), "");
  EXPECT_EQ(stopsIn(run({"image", "view", folder_ / "v.png", folder_ / "w.png"}).out), "")
      << "integers are as they were shown";
  EXPECT_TRUE(bytes("v.png") == bytes("w.png"));
}

TEST_F(Exposure, RefusesTemperaturesOfNoLight) {
  for (const char* kelvin : {"1999", "25001", "0", "nan", "1,1"})
    expectError({"render", folder_ / "m.gltf", "--probe", folder_ / "probe.pfm", "-o",
                 folder_ / "a.png", "--white-balance", kelvin},
                "--white-balance");
  expectError({"image", "view", folder_ / "probe.pfm", folder_ / "a.png", "--exposure", "autos"},
              "auto or a number from -100 to 100");
}

}  // namespace
}  // namespace chromeball::exposure_test
