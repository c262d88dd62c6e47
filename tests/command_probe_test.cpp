// SPDX-License-Identifier: Apache-2.0
// chromeball probe info, convert and synth; and errors in the command line itself.
#include <gtest/gtest.h>

#include <fstream>

#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_probe_test {
namespace {

using nlohmann::json;

CommandResult run(const std::vector<std::string>& arguments) {
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

TEST(SlowCommand, HelpAndVersionSucceed) {
  EXPECT_TRUE(run({"--version"}).out.starts_with("chromeball "));
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--help"},
                                             {"probe", "--help"},
                                             {"probe", "info", "--help"},
                                             {"probe", "convert", "--help"},
                                             {"probe", "synth", "--help"},
                                             {"image", "view", "--help"},
                                             {"image", "error", "--help"},
                                             {"render", "--help"}})
    EXPECT_FALSE(run(arguments).out.empty());
}

TEST(SlowCommand, UnknownWordsAreRejectedWithASuggestion) {
  expectError({}, "subcommand is required");
  expectError({"rendr"}, "`render`");
  expectError({"prob", "info"}, "`probe`");
  expectError({"probe", "inf", "x"}, "`info`");
  expectError({"probe", "synth", "constant", "x.exr", "--sun-elevation", "30"},
              "--sun-elevation: not an option of constant; only of sun-sky");
  expectError({"probe", "info", "x", "--jsn"}, "`--json`");
  expectError({"probe", "info"}, "FILE");
  expectError({"probe", "info", "a", "b"}, "`b`");
  expectError({"probe", "synth", "sun-sky", "a.exr", "--turbidity", "much"}, "--turbidity");
}

TEST(SlowCommandProbe, SynthAndInfoAgree) {
  const TemporaryFolder folder;
  const std::string path = folder / "sun.exr";
  run({"probe", "synth", "one-hot", path, "--size", "64x32", "--texel", "5,20", "--radiance",
       "3e5,2e5,1e5"});
  const json info = parseJson(run({"probe", "info", path, "--json"}).out);
  EXPECT_EQ(info["width"], 64);
  EXPECT_EQ(info["height"], 32);
  EXPECT_EQ(info["mapping"], "lat-long");
  EXPECT_EQ(info["mapping_guessed"], true);
  EXPECT_EQ(info["max"][1], 2e5);
  EXPECT_EQ(info["invalid_texels"]["nan"], 0);
  EXPECT_EQ(info["suns"].size(), 1u);
  EXPECT_EQ(info["brightest_shares"][0]["share"], 1.0);
  EXPECT_NE(run({"probe", "info", path}).out.find("lat-long (detected"), std::string::npos);
  EXPECT_EQ(
      parseJson(
          run({"probe", "info", path, "--json", "--mapping", "lat-long"}).out)["mapping_guessed"],
      false);
}

TEST(CommandProbe, InfoReportsInvalidTexels) {
  const TemporaryFolder folder;
  Image image = constantProbe({8, 4}, Rgb(1));
  image.setRgb(2, 1, Rgb(std::nanf("")));
  image.setRgb(3, 3, Rgb(-1));
  writeImage(folder / "bad.exr", image);
  const json info = parseJson(run({"probe", "info", folder / "bad.exr", "--json"}).out);
  EXPECT_EQ(info["invalid_texels"]["nan"], 1);
  EXPECT_EQ(info["invalid_texels"]["negative"], 1);
  EXPECT_EQ(info["invalid_texels"]["first"], json({2, 1}));
}

TEST(SlowCommandProbe, EveryKindAndFormat) {
  const TemporaryFolder folder;
  for (const auto& [kind, extension] : {std::pair{"constant", ".pfm"},
                                        {"one-hot", ".EXR"},
                                        {"gradient", ".hdr"},
                                        {"sun-sky", ".exr"},
                                        {"overcast", ".png"},
                                        {"studio", ".hdr"}}) {
    const std::string path = folder / (std::string(kind) + extension);
    run({"probe", "synth", kind, path, "--size", "32x16"});
    const Image image = readImage(path);
    EXPECT_EQ(image.width, 32) << path;
    EXPECT_EQ(image.height, 16) << path;
  }
}

TEST(SlowCommandProbe, ConvertRoundTrip) {
  const TemporaryFolder folder;
  run({"probe", "synth", "gradient", folder / "a.exr", "--size", "64x32"});
  for (const char* to :
       {"angular", "mirror-ball", "cube-cross", "cube-strip", "cube-3x2", "lat-long"}) {
    run({"probe", "convert", folder / "a.exr", folder / "b.exr", "--to", to});
    run({"probe", "convert", folder / "b.exr", folder / "c.exr", "--from", to, "--to", "lat-long",
         "--size", "64x32"});
    const Image a = readImage(folder / "a.exr"), c = readImage(folder / "c.exr");
    ASSERT_EQ(c.texels.size(), a.texels.size());
    double difference = 0;
    for (size_t i = 0; i < a.texels.size(); ++i)
      difference += std::fabs(a.texels[i] - c.texels[i]) / double(a.texels.size());
    EXPECT_LT(difference, 0.02) << to;
  }
  run({"probe", "convert", folder / "a.exr", folder / "w.exr", "--to", "cube-cross", "--size",
       "64x48"});
  EXPECT_EQ(readImage(folder / "w.exr").width, 64);
}

TEST(SlowCommandProbe, AGridOfFacesIsDetectedWithANote) {
  const TemporaryFolder folder;
  run({"probe", "synth", "gradient", folder / "a.exr", "--size", "64x32"});
  run({"probe", "convert", folder / "a.exr", folder / "grid.pfm", "--to", "cube-3x2"});
  const CommandResult back =
      run({"probe", "convert", folder / "grid.pfm", folder / "b.exr", "--to", "lat-long"});
  EXPECT_NE(back.error.find("detected as cube-3x2"), std::string::npos) << back.error;
  const json info =
      parseJson(run({"probe", "info", folder / "grid.pfm", "--json", "--mapping-report"}).out);
  EXPECT_EQ(info["mapping"], "cube-3x2");
  EXPECT_EQ(info["width"], 48);
  EXPECT_EQ(info["height"], 32);
  EXPECT_EQ(info["mapping_report"]["texels"], 48 * 32);
  EXPECT_NEAR(info["mapping_report"]["max_over_min"].get<double>(), 4.506,
              0.001);  // 3 sqrt(3) for many texels
  EXPECT_NE(run({"probe", "info", folder / "a.exr", "--mapping-report"}).out.find("solid angle"),
            std::string::npos);
  expectError({"probe", "convert", folder / "a.exr", folder / "c.exr", "--to", "cube-3x2", "--size",
               "64x64"},
              "3:2, of square faces");
  expectError({"probe", "info", folder / "a.exr", "--mapping", "cube-3x2"}, "3:2");
}

TEST(SlowCommandProbe, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "b.exr";
  writeImage(in, constantProbe({8, 4}, Rgb(1)));
  std::ofstream(folder / "not.hdr") << "hello";
  expectError({"probe", "info", folder / "none.exr"}, "no such file");
  expectError({"probe", "info", folder / "not.hdr"}, "not.hdr");
  expectError({"probe", "info", in, "--mapping", "angulr"}, "`angular`");
  expectError({"probe", "info", in, "--mapping", "angular"}, "square");
  expectError({"probe", "convert", in, out}, "--to");
  expectError({"probe", "convert", in, out, "--to", "auto"}, "--to");
  expectError({"probe", "convert", in, out, "--to", "cube"}, "cube-cross");
  expectError({"probe", "convert", in, out, "--to", "auto", "--size", "8x4"}, "--to");
  expectError({"probe", "convert", in, out, "--to", "angular", "--size", "8x4"}, "square");
  expectError({"probe", "convert", in, out, "--to", "lat-long", "--size", "8"}, "--size");
  expectError({"probe", "convert", in, out, "--to", "lat-long", "--rotation", "nan"},
              "--probe-rotation");
  expectError({"probe", "convert", in, folder / "b.bmp", "--to", "lat-long"}, ".exr");
  expectError({"probe", "convert", in, folder / "no/b.exr", "--to", "lat-long"}, "no folder");
  expectError({"probe", "synth", "cloudy", out}, "known");
  expectError({"probe", "synth", "constant", out, "--size", "0x4"}, "--size");
  expectError({"probe", "synth", "constant", out, "--size", "65536x65536"}, "--size");
  expectError({"probe", "synth", "constant", out, "--radiance", "1,2"}, "--radiance");
  expectError({"probe", "synth", "constant", out, "--radiance", "1,2,-3"}, "--radiance");
  expectError({"probe", "synth", "constant", out, "--radiance", "1,2,1e300"}, "--radiance");
  expectError({"probe", "synth", "one-hot", out, "--size", "8x4", "--texel", "8,0"}, "--texel");
  expectError({"probe", "synth", "one-hot", out, "--direction", "0,0,0"}, "--direction");
  expectError({"probe", "synth", "gradient", out, "--slope", "1,1,1"}, "--slope");
  expectError({"probe", "synth", "sun-sky", out, "--sun-elevation", "95"}, "--sun-elevation");
  expectError({"probe", "synth", "sun-sky", out, "--turbidity", "50"}, "--turbidity");
  expectError({"probe", "synth", "sun-sky", out, "--ground-albedo", "2"}, "--ground-albedo");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "not.hdr"}));
}

}  // namespace
}  // namespace chromeball::command_probe_test
