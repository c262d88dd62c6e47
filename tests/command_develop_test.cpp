// SPDX-License-Identifier: Apache-2.0
// chromeball image develop, and the setting `develop` of renders.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.h"
#include "front/arguments.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::command_develop_test {
namespace {

Image filled(int width, int height, int channels, float number) {
  Image image(width, height, channels);
  std::ranges::fill(image.texels, number);
  return image;
}

// A lamp of 100 on 0.01, with a depth of 5 metres.
void writeLamp(const std::string& path, const Metadata& metadata = {}) {
  Image color = filled(64, 32, 3, 0.01f);
  color.setRgb(32, 16, Rgb(100));
  writeImage(path, OutputImage{{{"", "RGB", std::move(color)}, {"depth", "", filled(64, 32, 1, 5)}},
                               metadata});
}

CommandResult run(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"image", "develop"});
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

TEST(CommandDevelop, BlurIsBeforeToneMapping) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.png", linear = folder / "out.exr";
  writeLamp(in);
  run({in, linear, "--motion", "40@0"});
  EXPECT_NEAR(readImage(linear).rgb(20, 16).x, 100.0 / 40 + 0.01, 1e-2);
  run({in, out, "--motion", "40@0", "--exposure", "0"});
  EXPECT_EQ(readImage(out).rgb(20, 16).x, 1) << "the streak is white";
  run({in, out, "--motion", "40@0", "--clip", "1", "--exposure", "0"});
  EXPECT_LT(readImage(out).rgb(20, 16).x, 0.05f) << "clipped first, it is grey";
  // White is at radiance 8 with an exposure of -3 stops: that is where the image is clipped.
  run({in, linear, "--clip", "1", "--exposure", "-3"});
  EXPECT_NEAR(readImage(linear).rgb(32, 16).x, 8, 1e-5);
}

TEST(CommandDevelop, WithoutOptionsNothingChanges) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.exr";
  writeLamp(in);
  run({in, out});
  EXPECT_EQ(readImage(out).texels, readImage(in).texels);
}

TEST(CommandDevelop, FieldOfViewOfTheFileOrTheOption) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", plain = folder / "plain.exr", a = folder / "a.exr",
                    b = folder / "b.exr";
  writeLamp(in, {{"cameraFov", 50.0f}});
  writeLamp(plain);
  run({in, a, "--vignette", ".4"});
  run({plain, b, "--vignette", ".4", "--fov", "50"});
  EXPECT_EQ(readImage(a).texels, readImage(b).texels);
  EXPECT_LT(readImage(a).rgb(0, 0).x, 0.0095f);
  expectError({"image", "develop", plain, a, "--vignette", ".4"}, "--fov DEGREES");
  expectError({"image", "develop", plain, a, "--glare", "spencer"}, "--fov DEGREES");
}

TEST(CommandDevelop, AllAtOnceKeepsAlphaAndMetadata) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.exr";
  writeImage(
      in, OutputImage{{{"", "RGBA", filled(40, 30, 4, 0.5f)}, {"depth", "", filled(40, 30, 1, 3)}},
                      {{"cameraFov", 40.0f}}});
  run({in, out, "--bloom", ".75:1,.15:8,.07:32,.03:128", "--glare", "spencer", "--motion", "9@30",
       "--depth-blur", "2:0.01", "--vignette", "0"});
  const ImageFile file = readImageFile(out);
  const std::optional<Image> color = findColorAndAlpha(file);
  ASSERT_TRUE(color);
  ASSERT_EQ(color->channels, 4);
  for (const float texel : color->texels) EXPECT_NEAR(texel, 0.5f, 1e-5f);
  EXPECT_TRUE(file.metadata.contains("cameraFov"));
}

// The header lists the steps, also after two runs; a message says that other layers are not
// written.
TEST(CommandDevelop, TheHeaderHasWhatWasDone) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", once = folder / "1.exr", twice = folder / "2.exr";
  writeImage(in, OutputImage{{{"", "RGB", filled(8, 8, 3, 1)}, {"depth", "", filled(8, 8, 1, 3)}},
                             {{"cameraFov", 40.0f}}});
  const CommandResult result = run({in, once, "--bloom", "1:2", "--vignette", ".5", "--exact"});
  EXPECT_NE(result.error.find("without the layers depth"), std::string::npos) << result.error;
  run({once, twice, "--motion", "3@0"});
  const auto developed = [](const std::string& path) {
    return std::get<std::string>(readImageFile(path).metadata.at("developed"));
  };
  EXPECT_EQ(developed(once), "bloom=1:2 vignette=.5 exact");
  EXPECT_EQ(developed(twice), "bloom=1:2 vignette=.5 exact; then motion=3@0");
  run({in, once});
  EXPECT_FALSE(readImageFile(once).metadata.contains("developed"));
}

// The attribute says how a map is turned: no file of ours has it.
TEST(CommandDevelop, EnvmapIsNotKept) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.exr";
  writeLamp(in, {{kEnvmapAttribute, std::string(kEnvmapLatLong)}, {"owner", std::string("me")}});
  const CommandResult result = run({in, out, "--clip", "1"});
  EXPECT_NE(result.error.find("its `envmap` attribute, which puts +Z in the centre, is not kept"),
            std::string::npos)
      << result.error;
  EXPECT_FALSE(readExrMetadata(out).contains(kEnvmapAttribute));
  EXPECT_TRUE(readExrMetadata(out).contains("owner"));
  EXPECT_EQ(run({in, folder / "out.png"}).error, "");
}

// What tells a probe's directions is kept by what changes its colour, or its loss is told.
TEST(CommandDevelop, MappingsAreKeptOrNamed) {
  const TemporaryFolder folder;
  const std::string ball = folder / "ball.exr", ones = folder / "ones.exr",
                    turned = folder / "turned.exr";
  const auto write = [](const std::string& path, const Metadata& metadata) {
    writeImage(path, OutputImage{{{"", "RGB", filled(16, 16, 3, 0.25f)}}, metadata});
  };
  Image disc = filled(16, 16, 3, 0.25f);  // black outside, as an angular map is too
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      if (std::hypot(x - 7.5, y - 7.5) > 8) disc.setRgb(x, y, Rgb(0));
  writeImage(ball,
             OutputImage{{{"", "RGB", disc}}, {{kMappingAttribute, std::string("mirror-ball")}}});
  write(ones, {});
  write(turned, {{kEnvmapAttribute, std::string(kEnvmapLatLong)}});
  const auto commandsTo = [&](const std::string& in, const std::string& out) {
    return std::vector<std::vector<std::string>>{
        {"image", "develop", in, out},
        {"image", "divide", in, ones, "-o", out},
        {"probe", "merge", in, in, "--exposures", "1,0.5", "--response", "linear", "--unaligned",
         "-o", out}};
  };
  for (const char* name : {"out.exr", "out.hdr"})
    for (const auto& command : commandsTo(ball, folder / name)) {
      const CommandResult result = runCommand(command);
      ASSERT_EQ(result.status, 0) << result.error;
      const Metadata kept = readImageFile(folder / name).metadata;
      ASSERT_TRUE(kept.contains(kMappingAttribute)) << command[1] << " to " << name;
      EXPECT_EQ(std::get<std::string>(kept.at(kMappingAttribute)), "mirror-ball");
    }
  for (const auto& command : commandsTo(ball, folder / "out.pfm"))
    EXPECT_NE(runCommand(command).error.find("has no place for its mapping, mirror-ball"),
              std::string::npos)
        << command[1];
  writeImage(folder / "lat-long.exr", OutputImage{{{"", "RGB", filled(16, 8, 3, 0.25f)}},
                                                  {{kMappingAttribute, std::string("lat-long")}}});
  EXPECT_EQ(run({folder / "lat-long.exr", folder / "out.pfm"}).error, "");  // its shape tells it
  for (const auto& command : commandsTo(turned, folder / "out.exr"))
    EXPECT_NE(runCommand(command).error.find("needs a rotation of 180 degrees"), std::string::npos)
        << command[1];
}

// Names in an .exr may hold anything; in an .hdr a line break would begin a line of the header.
TEST(CommandDevelop, MappingsOfOthersAreNoLinesOfAHeader) {
  const TemporaryFolder folder;
  const Image grey = filled(32, 32, 3, 0.25f);
  for (const std::string& name :
       {std::string("angular\nEXPOSURE= 1000"), std::string("angular\n\n-Y 1 +X 1\n"),
        std::string(5000, 'x'), std::string("ANGULAR")}) {
    const OutputImage named{{{"", "RGB", grey}}, {{kMappingAttribute, name}}};
    writeImage(folder / "in.exr", named);
    ASSERT_EQ(run({folder / "in.exr", folder / "out.hdr"}).status, 0);
    writeImage(folder / "direct.hdr", named);
    for (const char* file : {"out.hdr", "direct.hdr"})
      EXPECT_EQ(readImage(folder / file).texels, grey.texels) << name.substr(0, 20);
    EXPECT_FALSE(readImageFile(folder / "out.hdr").metadata.contains(kMappingAttribute));
  }
}

// A .pfm has the picture of the display window, whose shape and corners are looked at.
TEST(CommandDevelop, MappingsOfWindowsAreKeptOrNamed) {
  const TemporaryFolder folder;
  writeImage(folder / "in.exr", OutputImage{{{"", "RGB", filled(40, 40, 3, 0.25f)}},
                                            {{kMappingAttribute, std::string("mirror-ball")}},
                                            Placement{12, 12, 64, 64}});
  EXPECT_NE(
      run({folder / "in.exr", folder / "out.pfm"})
          .error.find("has no place for its mapping, mirror-ball, and will be taken for angular"),
      std::string::npos);
  ASSERT_EQ(run({folder / "in.exr", folder / "out.hdr"}).status, 0);
  EXPECT_TRUE(readImageFile(folder / "out.hdr").metadata.contains(kMappingAttribute));
}

TEST(CommandDevelop, InfinityIsClipped) {
  const TemporaryFolder folder;
  Image image = filled(4, 4, 3, 0.5f);
  image.at(1, 1)[0] = std::numeric_limits<float>::infinity();
  writeImage(folder / "in.exr", image);
  const CommandResult result = run({folder / "in.exr", folder / "out.exr", "--clip", "2"});
  EXPECT_EQ(result.error.find("infinite"), std::string::npos) << result.error;
  EXPECT_EQ(readImage(folder / "out.exr").rgb(1, 1), Rgb(2, 0.5f, 0.5f));
}

TEST(CommandDevelop, InvalidPixelsAreReported) {
  const TemporaryFolder folder;
  Image image = filled(32, 32, 3, 1);
  image.at(5, 5)[0] = std::numeric_limits<float>::quiet_NaN();
  writeImage(folder / "in.exr", image);
  const CommandResult result =
      run({folder / "in.exr", folder / "out.exr", "--bloom", ".5:1,.5:20"});
  EXPECT_NE(result.error.find("1 pixel is NaN or infinite"), std::string::npos) << result.error;
  for (const float texel : readImage(folder / "out.exr").texels) EXPECT_GT(texel, 0.5f);
}

TEST(CommandDevelop, BadInput) {
  const TemporaryFolder folder;
  const std::string in = folder / "in.exr", out = folder / "out.png";
  writeLamp(in);
  const auto expect = [&](const std::vector<std::string>& options, const char* reason) {
    std::vector<std::string> words{"image", "develop", in, out};
    words.insert(words.end(), options.begin(), options.end());
    expectError(words, reason);
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  expect({"--bloom", "1:1e9"}, "sigma (pixels) 1e+09 should be 0 to 4096");
  expect({"--bloom", "1:nan"}, "not a number");
  expect({"--bloom=-.5:1,1.5:2"}, "weight -0.5 should be 0 to 1");
  expect({"--bloom", ".5:1,.4:2"}, "the weights sum to 0.9");
  expect({"--bloom", "1"}, "is not WEIGHT:SIGMA");
  expect({"--bloom", "1:2,"}, "is not WEIGHT:SIGMA");
  expect({"--motion", "1e9@0"}, "length (pixels) 1e+09 should be 0 to 4096");
  expect({"--motion", "60"}, "is not LENGTH@ANGLE");
  expect({"--motion", "60@inf"}, "not a number");
  expect({"--vignette", "2"}, "strength 2 should be 0 to 1");
  expect({"--vignette", "none.exr"}, "none.exr");
  expect({"--glare", "spenser"}, "did you mean `spencer`");
  expect({"--depth-blur", "2"}, "is not FOCUS:APERTURE");
  expect({"--depth-blur", "0:1"}, "focus (metres) 0");
  expect({"--depth-blur", "1:1e9"}, "aperture (metres) 1e+09");
  expect({"--clip", "-1"}, "--clip: -1");
  expect({"--fov", "180", "--vignette", "1"}, "between 0 and 180");
  expect({"--fov", "40", "--clip", "1"}, "--fov: has no effect without");
  expect({"--exact", "--clip", "1"}, "--exact: has no effect without");
  expect({"--bloom", ""}, "`` is not WEIGHT:SIGMA");
  expect({"--vignette", ""}, "--vignette");
  expect({"--exposure", "nan"}, "--exposure");
  expect({"--tonemap", "acis"}, "aces");
  writeImage(folder / "no-depth.exr", filled(8, 8, 3, 1));
  expectError(
      {"image", "develop", folder / "no-depth.exr", out, "--depth-blur", "1:.1", "--fov", "40"},
      "has no layer `depth`");
  Image negative = filled(2, 2, 3, -1);
  writeImage(folder / "negative.exr", negative);
  expect({"--vignette", folder / "negative.exr"}, "they are factors");
  expectError({"image", "develop", in, in}, "would overwrite");
  expectError({"image", "develop", in, folder / "out.exr", "--tonemap", "aces"}, "is linear");
  expectError({"image", "develop", in, folder / "out.exr", "--exposure", "1"}, "is linear");
}

// The .png of a render is its .exr, developed; the .exr stays as rendered.
TEST(SlowCommandDevelop, RendersHaveTheirPngDeveloped) {
  const TemporaryFolder folder;
  writeSmallModel(folder / "m.gltf");
  Image probe(4, 2, 3);
  probe.texels.assign(probe.texels.size(), 0.7f);
  probe.setRgb(1, 0, Rgb(90, 40, 10));
  writeImage(folder / "probe.pfm", probe);
  const std::vector<std::string> render{
      "render", folder / "m.gltf", "--probe",  folder / "probe.pfm", "--size", "48x32", "--samples",
      "4",      "--tonemap",       "reinhard", "--exposure",         "0.5"};
  const auto rendered = [&](std::vector<std::string> more) {
    more.insert(more.begin(), render.begin(), render.end());
    const CommandResult result = runCommand(more);
    EXPECT_EQ(result.status, 0) << result.error;
    return result.error;
  };
  rendered({"-o", folder / "plain.exr", "--aov", "depth"});
  rendered({"-o", folder / "o.exr", "-o", folder / "o.png", "--aov", "depth", "--develop",
            "depth-blur=3:0.2 bloom=.75:1,.25:8 vignette=.5"});
  EXPECT_EQ(readImage(folder / "o.exr").texels, readImage(folder / "plain.exr").texels);
  run({folder / "plain.exr", folder / "developed.png", "--tonemap", "reinhard", "--depth-blur",
       "3:0.2", "--bloom", ".75:1,.25:8", "--vignette", ".5"});
  EXPECT_EQ(readImage(folder / "o.png").texels, readImage(folder / "developed.png").texels);
  EXPECT_EQ(rendered({"-o", folder / "only.png", "--aov", "depth", "--develop", "depth-blur=3:0.2"})
                .find("has no effect"),
            std::string::npos);
  EXPECT_NE(rendered({"-o", folder / "o.exr", "--develop", "bloom=1:3"}).find("has no effect"),
            std::string::npos);
}

TEST(DevelopText, SeveralInOneString) {
  const DevelopSettings settings =
      parseDevelop(" bloom=.75:1,.255:32  vignette=.4 motion=60@-30 ", "here");
  ASSERT_EQ(settings.bloom.size(), 2u);
  EXPECT_NEAR(settings.bloom[0].weight + settings.bloom[1].weight, 1, 1e-12);
  EXPECT_EQ(settings.vignette, 0.4);
  EXPECT_EQ(settings.motion->length, 60);
  EXPECT_TRUE(parseDevelop("", "here").isEmpty());
  EXPECT_THROW(parseDevelop("blom=1:1", "here"), InputError);
  EXPECT_THROW(parseDevelop("vignette", "here"), InputError);
  EXPECT_THROW(parseDevelop("vignette=.1 vignette=.2", "here"), InputError);
}

}  // namespace
}  // namespace chromeball::command_develop_test
