// SPDX-License-Identifier: Apache-2.0
// chromeball lights, lights-error and probe irradiance.
#include <gtest/gtest.h>

#include <fstream>

#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::command_lights_test {
namespace {

using nlohmann::json;

CommandResult run(const std::vector<std::string>& arguments) {
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

TEST(CommandIrradiance, OfAConstantProbe) {
  const TemporaryFolder folder;
  writeImage(folder / "in.exr", constantProbe({128, 64}, Rgb(1, 2, 3)));
  for (const char* method : {"exact", "sh"}) {
    run({"probe", "irradiance", folder / "in.exr", folder / "out.exr", "--size", "16x8", "--method",
         method});
    const Image map = readImage(folder / "out.exr");
    ASSERT_EQ(map.width, 16);
    ASSERT_EQ(map.height, 8);
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(map.rgb(x, 3)[c], kPi * (c + 1), 0.005);
  }
  run({"probe", "irradiance", folder / "in.exr", folder / "same.exr"});
  EXPECT_EQ(readImage(folder / "same.exr").width, 128);
}

TEST(CommandLights, EveryFormatAndThePreview) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr";
  writeImage(probe, studioProbe({64, 32}));
  run({"lights", probe, "--method", "median-cut", "--count", "8", "-o", folder / "a.json",
       "--preview", folder / "a.png"});
  const json file = jsonOfFile(folder / "a.json");
  EXPECT_EQ(file["probe"], probe);
  EXPECT_EQ(file["method"], "median-cut");
  EXPECT_FALSE(file.contains("ambient"));
  ASSERT_EQ(file["lights"].size(), 8u);
  for (const json& light : file["lights"]) {
    const json& d = light["direction"];
    EXPECT_NEAR(std::hypot(double(d[0]), double(d[1]), double(d[2])), 1, 1e-6);
    EXPECT_GT(light["irradiance"][0], 0);
    EXPECT_EQ(light["angle"], 0);
  }
  EXPECT_EQ(readImage(folder / "a.png").width, 1024);
  run({"lights", probe, "--method", "median-cut", "--count", "8", "-o", folder / "b.JSON"});
  EXPECT_EQ(jsonOfFile(folder / "b.JSON")["lights"], file["lights"]);
  run({"lights", probe, "--method", "median-cut", "--count", "8", "-o", folder / "a.gltf"});
  EXPECT_EQ(jsonOfFile(folder / "a.gltf")["nodes"].size(), 8u);
  run({"lights", probe, "--method", "median-cut", "--count", "8", "-o", folder / "a.csv"});
  const std::string csv = fileContents(folder / "a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 9);
}

TEST(CommandLights, RegionsAndLevels) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr", out = folder / "a.json";
  writeImage(probe, studioProbe({64, 32}));
  run({"lights", probe, "--method", "median-cut-centre", "--recursion", "3", "-o", out, "--preview",
       folder / "a.png", "--regions"});
  EXPECT_EQ(jsonOfFile(out)["lights"].size(), 8u);
  const Image preview = readImage(folder / "a.png");
  int red = 0, white = 0;
  for (int y = 0; y < preview.height; ++y)
    for (int x = 0; x < preview.width; ++x) {
      red += preview.rgb(x, y) == Rgb(1, 0, 0);
      white += preview.rgb(x, y) == Rgb(1);
    }
  EXPECT_GE(red, 8 * 9);
  EXPECT_GE(white, 512);  // at least the seam
  const std::string table = run({"lights-error", probe, "--methods", "median-cut,median-cut-flat",
                                 "--recursion", "1,3", "--normals", "80"})
                                .out;
  EXPECT_NE(table.find("median-cut-flat             8       8"), std::string::npos) << table;
}

// The numbers below the picture equal those of lights-error.
TEST(CommandLights, SpheresAndTheTableAgree) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr", out = folder / "a.txt";
  writeImage(probe, studioProbe({64, 32}));
  const std::string text = run({"lights", probe, "--method", "irradiance-fit-ambient", "--count",
                                "2", "-o", out, "--format", "opengl", "--sphere", folder / "s.png",
                                "--normals", "320", "--probe-mask", "below-horizon"})
                               .out;
  EXPECT_NE(fileContents(out).find("kProbeLights = 2"), std::string::npos);
  EXPECT_EQ(readImage(folder / "s.png").width, 1080);
  double mean = 0, max = 0;
  const size_t line = text.find("sphere ");
  ASSERT_NE(line, std::string::npos) << text;
  ASSERT_EQ(std::sscanf(text.c_str() + line, "sphere mean error %lf%%, maximum %lf%%", &mean, &max),
            2)
      << text;
  EXPECT_NE(text.find("; ambient radiance "), std::string::npos);
  run({"lights-error", probe, "--methods", "irradiance-fit-ambient", "--counts", "2", "--normals",
       "320", "--probe-mask", "below-horizon", "--csv", folder / "e.csv"});
  double tableMean = 0, tableMax = 0;
  const std::string csv = fileContents(folder / "e.csv");
  ASSERT_EQ(std::sscanf(csv.c_str() + csv.find('\n') + 1, "irradiance-fit-ambient,2,2,%lf,%lf",
                        &tableMean, &tableMax),
            2)
      << csv;
  EXPECT_NEAR(mean / tableMean, 1, 1e-3);
  EXPECT_NEAR(max / tableMax, 1, 1e-3);
}

// Options that have no effect are reported.
TEST(CommandLights, ASeedOfNoStochasticMethodIsSaid) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr";
  writeImage(probe, studioProbe({64, 32}));
  constexpr const char* kSaid = "--seed: has no effect";
  const auto lights = [&](const std::string& method) {
    return run({"lights", probe, "--method", method, "--count", "2", "-o", folder / "a.json",
                "--seed", "1"})
        .error;
  };
  const auto table = [&](const std::string& methods) {
    return run({"lights-error", probe, "--methods", methods, "--counts", "2", "--normals", "20",
                "--seed", "1"})
        .error;
  };
  EXPECT_NE(lights("median-cut").find(kSaid), std::string::npos);
  EXPECT_EQ(lights("lightgen").find(kSaid), std::string::npos);
  EXPECT_NE(table("median-cut,variance-cut").find(kSaid), std::string::npos);
  EXPECT_EQ(table("median-cut,lightgen").find(kSaid), std::string::npos);
}

TEST(CommandLights, AnAngleGivesARadiance) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr", out = folder / "a.json";
  writeImage(probe, studioProbe({64, 32}));
  run({"lights", probe, "--method", "median-cut", "--count", "3", "-o", out, "--angle", "1"});
  const json file = jsonOfFile(out);
  for (const json& light : file["lights"]) {
    EXPECT_EQ(light["angle"], 1);
    const double irradiance = light["irradiance"][1];
    EXPECT_NEAR(light["radiance"][1].get<double>() * 2.3925e-4 / irradiance, 1, 1e-4);
  }
}

TEST(CommandLights, SunsHaveTheirAngle) {
  const TemporaryFolder folder;
  const std::string probe = folder / "two.exr", out = folder / "a.json";
  Image map = constantProbe({256, 128}, Rgb(0.1f));
  addSunDisc(map, {0, 0, -1}, 3, dvec3(5));
  addSunDisc(map, {1, 0, 0}, 4, dvec3(9));
  writeImage(probe, map);
  run({"lights", probe, "--method", "suns", "-o", out});
  EXPECT_EQ(jsonOfFile(out)["lights"].size(), 2u);
  run({"lights", probe, "--method", "suns", "--count", "1", "-o", out});
  const json lights = jsonOfFile(out)["lights"];
  ASSERT_EQ(lights.size(), 1u);
  EXPECT_NEAR(lights[0]["direction"][0], 1, 1e-3);
  EXPECT_NEAR(lights[0]["irradiance"][1], 9, 0.02);
  EXPECT_NEAR(lights[0]["angle"], 4, 0.7);  // texels of 1.4 degrees blur it
}

TEST(SlowCommandLights, IrradianceFitChoosesTheNumberOfLights) {
  const TemporaryFolder folder;
  const std::string probe = folder / "studio.exr", out = folder / "a.json";
  writeImage(probe, studioProbe({64, 32}));
  run({"lights", probe, "--method", "irradiance-fit", "--max-error", "5%", "--ambient", "-o", out});
  const json file = jsonOfFile(out);
  EXPECT_EQ(file["ambient"].size(), 3u);
  const size_t count = file["lights"].size();
  EXPECT_GE(count, 1u);
  EXPECT_LE(count, 20u);
  const CommandResult capped = run({"lights", probe, "--method", "irradiance-fit", "--max-error",
                                    "0.0001", "--count", "2", "-o", out});
  EXPECT_LE(jsonOfFile(out)["lights"].size(), 2u);
  EXPECT_NE(capped.error.find("do not reach"), std::string::npos);
}

TEST(SlowCommandLights, ErrorTableCsvAndPlot) {
  const TemporaryFolder folder;
  writeImage(folder / "studio.exr", studioProbe({64, 32}));
  const std::string table = run({"lights-error", folder / "studio.exr", "--methods",
                                 "median-cut,variance-cut", "--counts", "2,8,32,128", "--normals",
                                 "1280", "--csv", folder / "e.csv", "--plot", folder / "e.svg"})
                                .out;
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 9);

  std::ifstream csv(folder / "e.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "method,count,lights,mean_percent,max_percent,seconds");
  double first = 0, mean = 0, max = 0;
  int count = 0, lights = 0;
  for (int i = 0; i < 4 && std::getline(csv, line); ++i) {
    ASSERT_EQ(std::sscanf(line.c_str(), "median-cut,%d,%d,%lf,%lf", &count, &lights, &mean, &max),
              4)
        << line;
    EXPECT_EQ(count, lights);
    EXPECT_GT(max, mean);
    if (i == 0) first = mean;
  }
  EXPECT_LT(mean, first / 4);

  const std::string svg = fileContents(folder / "e.svg");
  EXPECT_TRUE(svg.starts_with("<svg xmlns"));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find(">variance-cut</text>"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

// Counts and methods in any order and given twice: one row and one point for each, from left to
// right in the plot.
TEST(SlowCommandLights, ErrorPlotOfCountsInAnyOrder) {
  const TemporaryFolder folder;
  writeImage(folder / "studio.exr", studioProbe({64, 32}));
  const auto plotOf = [&](const std::string& methods, const std::string& counts) {
    const std::string table =
        run({"lights-error", folder / "studio.exr", "--methods", methods, "--counts", counts,
             "--normals", "80", "--plot", folder / "e.svg"})
            .out;
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
    return fileContents(folder / "e.svg");
  };
  EXPECT_EQ(plotOf("median-cut", "2,8,32"), plotOf("median-cut,median-cut", "32,2,8,2,32"));
}

// A message names what a file cannot hold: ambient light, angles, units, many lights.
TEST(SlowCommandLights, WarnsOfWhatAFileLoses) {
  const TemporaryFolder folder;
  const std::string probe = folder / "probe.exr";
  writeImage(probe, studioProbe({64, 32}));
  const auto errorsOf = [&](const std::string& file, std::vector<std::string> more,
                            const std::string& method = "irradiance-fit") {
    more.insert(more.begin(), {"lights", probe, "--method", method, "-o", folder / file});
    return run(more).error;
  };
  const auto has = [](const std::string& text, const char* words) {
    return text.find(words) != std::string::npos;
  };
  const std::vector<std::string> ambient{"--count", "1", "--ambient"};
  EXPECT_TRUE(has(errorsOf("a.csv", ambient), "the fitted ambient light is not in a .csv"));
  EXPECT_TRUE(has(errorsOf("a.gltf", ambient), "the fitted ambient light is only in `extras`"));
  for (const char* file : {"a.json", "a.h"}) EXPECT_EQ(errorsOf(file, ambient), "");
  const std::vector<std::string> angle{"--count", "1", "--angle", "2"};
  EXPECT_TRUE(has(errorsOf("a.gltf", angle), "angular diameter is only in `extras`"));
  EXPECT_TRUE(has(errorsOf("a.h", angle), "angular diameter is not in a header"));
  for (const char* file : {"a.json", "a.csv"}) EXPECT_EQ(errorsOf(file, angle), "");
  const std::vector<std::string> units{"--count", "1", "--light-units", "radiometric"};
  EXPECT_TRUE(has(errorsOf("a.json", units), "--light-units: has no effect"));
  EXPECT_EQ(errorsOf("a.gltf", units), "");
  EXPECT_TRUE(has(errorsOf("a.h", {"--count", "16"}, "median-cut"), "16 lights; OpenGL"));
  EXPECT_EQ(errorsOf("a.h", {"--count", "8"}, "median-cut"), "");
  EXPECT_FALSE(has(fileContents(folder / "a.h"), "ambient light in place"));
  EXPECT_EQ(errorsOf("a.h", ambient), "");
  EXPECT_TRUE(has(fileContents(folder / "a.h"), "and the ambient light in place"));
}

// A mask that leaves no light is reported; no black light is written.
TEST(SlowCommandLights, OfProbesWithLittleLight) {
  const TemporaryFolder folder;
  const std::string probe = folder / "probe.exr", out = folder / "a.json";
  writeImage(probe, oneHotProbe({64, 32}, 3, 25, Rgb(1)));
  const CommandResult masked = run({"lights", probe, "--method", "median-cut", "--count", "2",
                                    "--probe-mask", "below-horizon", "-o", out});
  EXPECT_NE(masked.error.find("--probe-mask: below-horizon leaves no light"), std::string::npos);
  writeImage(probe, constantProbe({4, 2}, Rgb(0)));
  run({"lights", probe, "--method", "irradiance-fit", "--count", "3", "-o", out});
  EXPECT_EQ(jsonOfFile(out)["lights"].size(), 0u);
}

// Coarse probes have the same error as finer ones.
TEST(SlowCommandLights, ErrorOfAProbeOfOneTexel) {
  const TemporaryFolder folder;
  const auto errorOf = [&](const ImageSize& size) {
    writeImage(folder / "a.exr", constantProbe(size, Rgb(2)));
    run({"lights-error", folder / "a.exr", "--methods", "irradiance-fit-ambient", "--counts", "1",
         "--normals", "1280", "--csv", folder / "a.csv"});
    const std::string csv = fileContents(folder / "a.csv");
    double mean = -1;
    EXPECT_EQ(std::sscanf(csv.c_str() + csv.find('\n') + 1, "%*[^,],%*d,%*d,%lf", &mean), 1) << csv;
    return mean;
  };
  for (const ImageSize& size : {ImageSize{1, 1}, {2, 1}, {4, 2}, {128, 64}}) {
    const double percent = errorOf(size);
    EXPECT_GE(percent, 0) << size.width;
    EXPECT_LT(percent, 0.02) << size.width;
  }
}

TEST(SlowCommandLights, ABlackProbeIsAccepted) {
  const TemporaryFolder folder;
  const std::string probe = folder / "black.exr";
  writeImage(probe, constantProbe({32, 16}, Rgb(0)));
  run({"lights", probe, "--method", "median-cut", "--count", "4", "-o", folder / "a.gltf",
       "--preview", folder / "a.png"});
  run({"lights-error", probe, "--methods", "median-cut,irradiance-fit", "--counts", "2",
       "--normals", "80", "--plot", folder / "e.svg"});
  EXPECT_EQ(fileContents(folder / "e.svg").find("nan"), std::string::npos);
}

TEST(SlowCommandLights, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "a.json";
  writeImage(in, constantProbe({32, 16}, Rgb(1)));
  const std::vector<std::string> lights{"lights", in, "--count", "4", "-o", out, "--method"};
  const auto with = [](std::vector<std::string> arguments,
                       std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
    return arguments;
  };
  expectError(with(lights, {"medain-cut"}), "`median-cut`");
  expectError(with(lights, {"irradiance-fitt"}), "`irradiance-fit`");
  expectError(with(lights, {"median-cut", "--ambient"}), "--ambient");
  expectError(with(lights, {"median-cut", "--max-error", "5%"}), "--max-error");
  expectError(with(lights, {"irradiance-fit", "--max-error", "-5"}), "--max-error");
  expectError(with(lights, {"irradiance-fit", "--max-error", "five"}),
              "--max-error: `five` is not a number");
  expectError(with(lights, {"median-cut", "--preview", folder / "a.jpg"}), ".png");
  expectError(with(lights, {"median-cut", "--regions"}), "--preview");
  expectError(with(lights, {"irradiance-fit", "--preview", folder / "a.png", "--regions"}),
              "--regions: irradiance-fit");
  for (const char* angle : {"0", "-1", "10.5", "nan"})
    expectError(with(lights, {"median-cut", "--angle", angle}), "--angle");
  expectError(with(lights, {"median-cut", "--format", "opengles"}), "`opengl`");
  expectError(with(lights, {"median-cut", "--normals", "320"}), "--sphere");
  expectError(with(lights, {"median-cut", "--sphere", folder / "s.png", "--normals", "321"}),
              "--normals: 321");
  expectError(with(lights, {"median-cut", "--sphere", folder / "s.jpg"}), ".png");
  expectError(with(lights, {"median-cut", "--probe-mask", "below-horizn"}), "`below-horizon`");
  expectError(with(lights, {"median-cut", "--recursion", "3"}), "--recursion: excludes --count");
  expectError({"lights", in, "--method", "penrose", "--recursion", "3", "-o", out},
              "--recursion: penrose");
  expectError({"lights", in, "--method", "median-cut", "--recursion", "13", "-o", out}, "1 to 12");
  expectError({"lights", in, "--method", "median-cut", "-o", out}, "--count");
  expectError({"lights", in, "--method", "median-cut", "--count", "4", "-o", folder / "a.txt"},
              ".json");
  expectError({"lights", in, "--method", "median-cut", "--count", "4", "-o", folder / "b/a.csv"},
              "no folder");
  expectError({"lights", in, "--method", "median-cut", "--count", "-4", "-o", out}, "count");
  expectError({"lights", in, "--method", "irradiance-fit", "--count", "0", "-o", out}, "count");
  expectError({"lights", in, "--method", "irradiance-fit", "--count", "2000000000", "-o", out},
              "count");
  expectError({"lights", folder / "none.exr", "--method", "median-cut", "--count", "4", "-o", out},
              "no such file");
  const std::vector<std::string> errors{"lights-error", in, "--methods", "median-cut", "--counts"};
  expectError(with(errors, {"two"}), "--counts");
  expectError(with(errors, {"2", "--normals", "1000"}), "1280");
  expectError(with(errors, {"2", "--probe-mask", "sky"}), "--probe-mask");
  expectError(with(errors, {"2", "--csv", folder / "a.txt"}), ".csv");
  expectError(with(errors, {"2", "--plot", folder / "a.png"}), ".svg");
  expectError({"lights-error", in, "--methods", "median-cut"}, "--counts");
  expectError(with(errors, {"2", "--recursion", "2"}), "--recursion: excludes --counts");
  expectError(with(errors, {"2", "--seed", "-1"}), "--seed: `-1`");
  expectError(with(lights, {"median-cut", "--seed", "-1"}), "--seed: `-1`");
  expectError({"lights-error", in, "--methods", "lightgen", "--recursion", "2"}, "lightgen");
  expectError({"lights-error", in, "--methods", "median-cut", "--recursion", "0"}, "1 to 12");
  expectError({"lights-error", in, "--methods", "median-cut,suns-cut", "--counts", "2"},
              "suns-cut");
  // All counts are checked before the first row.
  const CommandResult late =
      runCommand({"lights-error", in, "--methods", "median-cut,cube-grid", "--counts", "2,300"});
  EXPECT_EQ(late.status, 2);
  EXPECT_EQ(late.out, "");
  EXPECT_NE(late.error.find("cube-grid: a count of 300 is out of range"), std::string::npos);
  expectError({"probe", "irradiance", in, folder / "o.exr", "--method", "exakt"}, "`exact`");
  expectError({"probe", "irradiance", in, folder / "o.exr", "--size", "0x2"}, "--size");
  expectError({"probe", "irradiance", in, folder / "o.jpg"}, ".exr");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr"}));
}

}  // namespace
}  // namespace chromeball::command_lights_test
