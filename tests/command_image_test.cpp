// SPDX-License-Identifier: Apache-2.0
// chromeball image error and view.
#include <gtest/gtest.h>

#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::command_image_test {
namespace {

using nlohmann::json;

Image filled(int w, int h, int channels, float number) {
  Image image(w, h, channels);
  std::fill(image.texels.begin(), image.texels.end(), number);
  return image;
}

CommandResult run(const std::vector<std::string>& arguments) {
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

TEST(CommandImage, ErrorMetrics) {
  const TemporaryFolder folder;
  writeImage(folder / "a.exr", filled(4, 3, 3, 1.5f));
  writeImage(folder / "b.pfm", filled(4, 3, 3, 1));
  const json error =
      parseJson(run({"image", "error", folder / "a.exr", folder / "b.pfm", "--json"}).out);
  EXPECT_EQ(error["mse"], 0.25);
  EXPECT_EQ(error["bias"], 0.5);
  EXPECT_EQ(error["max_difference"], 0.5);
  EXPECT_NEAR(double(error["relmse"]), 0.25 / 1.01, 1e-9);
  EXPECT_FALSE(error.contains("z"));
  EXPECT_NE(
      run({"image", "error", folder / "a.exr", folder / "b.pfm"}).out.find("mse             0.25"),
      std::string::npos);
  const json same =
      parseJson(run({"image", "error", folder / "a.exr", folder / "a.exr", "--json"}).out);
  EXPECT_EQ(same["mse"], 0.0);
  EXPECT_TRUE(same["psnr"].is_null());
}

// A file whose data window is not its display window reads like one with the whole display window:
// data in its place, black elsewhere, the rest cropped.
TEST(CommandImage, FilesAreTheirDisplayWindows) {
  const TemporaryFolder folder;
  const std::string part = folder / "part.exr", whole = folder / "whole.exr", a = folder / "a.png",
                    b = folder / "b.png", pfm = folder / "a.pfm", exr = folder / "a.exr";
  Image color(8, 6, 4), depth(8, 6, 1), variance = filled(8, 6, 3, 0.01f);
  for (int i = 0; i < 48; ++i) {
    for (int c = 0; c < 3; ++c) color.texels[size_t(4 * i + c)] = 0.02f * float(i % 7 + c);
    color.texels[size_t(4 * i + 3)] = 1;
    depth.texels[size_t(i)] = float(1 + i);
  }
  for (const Placement& placement :
       {Placement{3, 2, 16, 12}, Placement{-3, -2, 4, 3}, Placement{-2, 4, 16, 8}}) {
    writeImage(part, OutputImage{{{"", "RGBA", color},
                                  {"depth", "", depth},
                                  {"variance", "RGB", variance},
                                  {"light.sun", "RGB", variance}},
                                 {},
                                 placement});
    const ImageFile file = readImageFile(part);
    writeImage(whole, OutputImage{{{"", "RGBA", colorAndAlphaOf(ImageFile(file), part)},
                                   {"variance", "RGB", *layerOf(file, "variance", part)}},
                                  {}});
    run({"image", "view", part, a});
    run({"image", "view", whole, b});
    EXPECT_EQ(readImage(a).width, placement.width);
    EXPECT_EQ(readImage(a).texels, readImage(b).texels);
    run({"image", "view", part, a, "--layer", "depth"});
    EXPECT_EQ(readImage(a).height, placement.height);
    for (const std::vector<std::string>& pair : {std::vector{part, whole}, {whole, part}}) {
      const json error = parseJson(run({"image", "error", pair[0], pair[1], "--json"}).out);
      EXPECT_EQ(error["max_difference"], 0.0);
      EXPECT_EQ(error["z"]["mean"], 0.0);
    }
    const Image shown = readImage(part);
    run({"image", "develop", part, pfm});
    EXPECT_EQ(readImage(pfm).texels, shown.texels);
    run({"image", "develop", part, exr});
    EXPECT_EQ(readImage(exr).texels, shown.texels);
    EXPECT_EQ(readImageFile(exr).placement->x, placement.x) << "an .exr keeps its windows";
    run({"image", "relight", part, "--gain", "sun=1", "-o", pfm});
    EXPECT_EQ(readImage(pfm).width, placement.width);
  }
}

TEST(CommandImage, ErrorInSigmas) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, float radiance, float variance) {
    writeImage(folder / name, OutputImage{{{"", "RGB", filled(4, 3, 3, radiance)},
                                           {"variance", "RGB", filled(4, 3, 3, variance)}},
                                          {}});
  };
  write("a.exr", 1.5f, 0.01f);
  write("b.exr", 1, 0.0025f);
  const json z =
      parseJson(run({"image", "error", folder / "a.exr", folder / "b.exr", "--json"}).out)["z"];
  EXPECT_EQ(z["count"], 36);
  EXPECT_NEAR(double(z["mean"]), 0.5 / std::sqrt(0.0125), 1e-5);
  EXPECT_EQ(z["beyond_3_sigma"], 1.0);
  EXPECT_NEAR(double(z["largest"]), 0.5 / std::sqrt(0.0125), 1e-5);
  // The probability that any of 36 normal deviates exceeds 4.472 is 36 x 7.7e-6.
  EXPECT_NEAR(double(z["p_value"]), 36 * 7.744e-6, 1e-6);
  const std::string map = folder / "map.png";
  run({"image", "error", folder / "a.exr", folder / "b.exr", "-o", map, "--map", "z"});
  EXPECT_GT(luminance(readImage(map).rgb(1, 1)), 0.5f) << "4.5 of 5 sigma";
}

TEST(CommandImage, ErrorImage) {
  const TemporaryFolder folder;
  Image a = filled(16, 8, 3, 1);
  writeImage(folder / "b.exr", a);
  for (int x = 0; x < 8; ++x) a.setRgb(x, 3, Rgb(3));
  writeImage(folder / "a.exr", a);
  const std::string map = folder / "map.png";
  const auto isHot = [&](int x, int y) { return luminance(readImage(map).rgb(x, y)) > 0.5f; };
  for (const char* kind : {"relative", "flip"}) {
    const std::string out =
        run({"image", "error", folder / "a.exr", folder / "b.exr", "-o", map, "--map", kind}).out;
    EXPECT_NE(out.find("map             " + std::string(kind)), std::string::npos) << out;
    EXPECT_FALSE(isHot(15, 7)) << kind;
    EXPECT_EQ(isHot(2, 3), kind == std::string("relative"));
  }
  const json error = parseJson(
      run({"image", "error", folder / "a.exr", folder / "b.exr", "--json", "--flip"}).out);
  EXPECT_GT(error["flip"], 0.01);
  EXPECT_LT(error["flip"], 1);
}

// Integers are display-referred, whatever the file is called.
TEST(CommandImage, FlipDependsOnTheContent) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"}) {
    const std::string png = folder / std::string(name) + ".png";
    writeImage(png, filled(16, 8, 3, *name == 'a' ? 0.2f : 0.6f));
    std::filesystem::copy(png, folder / name);
  }
  const auto flipOf = [&](const std::string& extension) -> double {
    return parseJson(run({"image", "error", (folder / "a") + extension, (folder / "b") + extension,
                          "--json", "--flip"})
                         .out)["flip"];
  };
  EXPECT_GT(flipOf(".png"), 0.1);
  EXPECT_EQ(flipOf(""), flipOf(".png"));
}

TEST(CommandImage, ViewAppliesExposureAndTransfer) {
  const TemporaryFolder folder;
  writeImage(folder / "a.exr", filled(2, 2, 3, 0.125f));
  run({"image", "view", folder / "a.exr", folder / "a.png", "--exposure", "2"});
  EXPECT_NEAR(readImage(folder / "a.png").rgb(1, 1).x, 0.5f, 0.004f);
  for (const char* tone : {"none", "reinhard", "aces", "neutral", "filmic"})
    run({"image", "view", folder / "a.exr", folder / "a.png", "--tonemap", tone});
}

TEST(CommandImage, ViewShowsLayers) {
  const TemporaryFolder folder;
  Image depth(2, 1, 1), normal(2, 1, 3);
  depth.texels = {2, 1e10f};
  normal.setRgb(0, 0, Rgb(0, 1, 0));
  const std::string path = folder / "a.exr", png = folder / "a.png";
  writeImage(
      path,
      OutputImage{
          {{"", "RGB", filled(2, 1, 3, 1)}, {"depth", "Z", depth}, {"normal", "XYZ", normal}}, {}});
  run({"image", "view", path, png, "--layer", "depth"});
  EXPECT_EQ(readImage(png).rgb(0, 0), Rgb(1));
  EXPECT_EQ(readImage(png).rgb(1, 0), Rgb(0));
  run({"image", "view", path, png, "--layer", "normal"});
  EXPECT_NEAR(readImage(png).rgb(0, 0).x, 0.5f, 0.004f);
  EXPECT_EQ(readImage(png).rgb(0, 0).y, 1);
  expectError({"image", "view", path, png, "--layer", "dept"}, "`depth`");
}

TEST(CommandImage, ViewShowsEveryKindOfLayer) {
  const TemporaryFolder folder;
  const auto row = [](int channels, const std::vector<float>& texels) {
    Image image(int(texels.size()) / channels, 1, channels);
    image.texels = texels;
    return image;
  };
  const std::string path = folder / "a.exr", png = folder / "a.png";
  writeImage(path, OutputImage{{{"", "RGBA", row(4, {1, 1, 1, 0.5f, 1, 1, 1, 1, 1, 1, 1, 0})},
                                {"alpha", "A", row(1, {0, 0.25f, 1})},
                                {"node", "", row(1, {0, 1, 2})},
                                {"samples", "", row(1, {16, 32, 64})},
                                {"variance", "RGB", row(3, {0, 0, 0, 1, 1, 1, NAN, NAN, NAN})},
                                {"invalid", "RGB", row(3, {0, 0, 0, 2, 0, 0, 4, 0, 1})},
                                {"depth", "Z", row(1, {INFINITY, 1, 3})}},
                               {{"manifest/node", "{\"1\": \"Wheel\", \"2\": \"Door\\nknob\"}"}}});
  const auto view = [&](const char* layer) {
    const CommandResult result = run({"image", "view", path, png, "--layer", layer});
    return std::pair(readImage(png), result.out);
  };
  const Image alpha = view("alpha").first;
  EXPECT_EQ(alpha.rgb(0, 0), Rgb(0));
  EXPECT_NEAR(alpha.rgb(1, 0).y, 0.25f, 0.01f);
  EXPECT_EQ(alpha.rgb(2, 0), Rgb(1));

  const auto [node, legend] = view("node");
  EXPECT_EQ(node.rgb(0, 0), Rgb(0));
  EXPECT_GT(glm::distance(node.rgb(1, 0), node.rgb(2, 0)), 0.3f);
  EXPECT_NE(legend.find("  1  Wheel\n"), std::string::npos) << legend;
  EXPECT_NE(legend.find("  2  Door knob\n"), std::string::npos) << legend;

  const Image samples = view("samples").first, variance = view("variance").first;
  EXPECT_LT(luminance(samples.rgb(0, 0)), luminance(samples.rgb(1, 0)));
  EXPECT_LT(luminance(samples.rgb(1, 0)), luminance(samples.rgb(2, 0)));
  EXPECT_LT(luminance(variance.rgb(0, 0)), luminance(variance.rgb(1, 0)));
  EXPECT_EQ(variance.rgb(2, 0), Rgb(1)) << "an unknown variance";
  EXPECT_NEAR(view("invalid").first.rgb(1, 0).x, 0.5f, 0.01f);
  const Image depth = view("depth").first;
  EXPECT_EQ(depth.rgb(0, 0), Rgb(0));
  EXPECT_EQ(depth.rgb(1, 0), Rgb(1));
  EXPECT_LT(depth.rgb(2, 0).x, 0.1f);

  // Without a layer `alpha`, the alpha of the colour channels is used.
  writeImage(path, row(4, {1, 1, 1, 0.5f}));
  EXPECT_NEAR(view("alpha").first.rgb(0, 0).x, 0.5f, 0.01f);
}

TEST(SlowCommandImage, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string a = folder / "a.exr", png = folder / "a.png";
  writeImage(a, filled(2, 2, 3, 1));
  writeImage(folder / "b.exr", filled(3, 2, 3, 1));
  expectError({"image", "error", a, folder / "b.exr"}, "same size");
  expectError({"image", "error", a}, "B");
  expectError({"image", "error", a, folder / "none.exr"}, "no such file");
  expectError({"image", "error", a, a, "--map", "z", "-o", png}, "--aov variance");
  expectError({"image", "error", a, a, "--map", "flipp", "-o", png}, "`flip`");
  for (const char* map : {"z", "flip", "relative"})
    expectError({"image", "error", a, a, "--map", map}, "--map: has no effect without --output");
  expectError({"image", "error", a, a, "-o", folder / "map.exr"}, ".png");
  expectError({"image", "view", a, folder / "a.gif"}, ".png");
  expectError({"image", "view", a, folder / "b.exr"}, ".png");
  expectError({"image", "view", a, png, "--tonemap", "reinhart"}, "`reinhard`");
  expectError({"image", "view", a, png, "--exposure", "nan"}, "--exposure");
  expectError({"image", "view", a, png, "--layer", "depth"}, "depth");
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "b.exr"}));
}

// Files from fuzzers are shown or rejected with one line, without a crash or partial output.
TEST(SlowCommandImage, DamagedFilesAreShownOrRejected) {
  const auto root = sharedData("bad/images");
  if (!root) GTEST_SKIP() << "no bad/images";
  const TemporaryFolder folder;
  int shown = 0, rejected = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*root)) {
    if (!entry.is_regular_file()) continue;
    const CommandResult result =
        runCommand({"image", "view", entry.path().string(), folder / "v.png"});
    const std::string& error = result.error;
    if (result.status == 0) {
      ++shown;
      EXPECT_TRUE(error.empty() || error.find("are negative") != std::string::npos) << error;
      EXPECT_EQ(folder.files(), std::vector<std::string>{"v.png"}) << entry.path();
      std::filesystem::remove(folder / "v.png");
    } else {
      ++rejected;
      EXPECT_EQ(result.status, 2) << entry.path();
      EXPECT_TRUE(error.starts_with("chromeball: " + entry.path().string() + ": ")) << error;
      EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
      EXPECT_TRUE(folder.files().empty()) << entry.path();
    }
  }
  EXPECT_GT(shown, 3);
  EXPECT_GT(rejected, 50);
}

}  // namespace
}  // namespace chromeball::command_image_test
