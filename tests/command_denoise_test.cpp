// SPDX-License-Identifier: Apache-2.0
// chromeball render --denoise and chromeball image denoise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/json.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "run_command.h"

namespace chromeball::command_denoise_test {
namespace {

class CommandDenoise : public testing::Test {
 protected:
  const TemporaryFolder folder_;

  std::vector<std::string> render(const std::string& output,
                                  std::vector<std::string> more = {}) const {
    std::vector<std::string> words{"render", scene("demo"), "-o", output};
    words.insert(words.end(), more.begin(), more.end());
    const auto lacks = [&](const char* option) { return std::ranges::count(more, option) == 0; };
    if (lacks("--size")) words.insert(words.end(), {"--size", "48x32"});
    if (lacks("--samples")) words.insert(words.end(), {"--samples", "16"});
    return words;
  }
  static std::string scene(const std::string& name) {
    return std::string(kSourceDir) + "/scenes/" + name + ".toml";
  }
  static std::string run(const std::vector<std::string>& words) {
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return result.out;
  }
};

class SlowCommandDenoise : public CommandDenoise {};

std::vector<float> layer(const std::string& path, const std::string& name) {
  const ImageFile file = readImageFile(path);
  const std::optional<Image> found = name.empty() ? findColor(file) : findLayer(file, name);
  EXPECT_TRUE(found) << path << " " << name;
  return found ? found->texels : std::vector<float>{};
}

TEST_F(CommandDenoise, WritesBothImagesAndTheError) {
  const std::string noisy = folder_ / "noisy.exr", out = folder_ / "out.exr",
                    stats = folder_ / "stats.json";
  run(render(noisy));
  const std::string said = run(render(out, {"--denoise", "--stats", stats}));
  EXPECT_NE(said.find("denoised to about"), std::string::npos) << said;
  EXPECT_EQ(layer(out, "noisy"), layer(noisy, ""));
  EXPECT_NE(layer(out, ""), layer(noisy, ""));
  for (const float error : layer(out, "denoise_error")) EXPECT_GE(error, 0);
  const auto json = jsonOfFile(stats);
  EXPECT_GT(json["denoised"]["noise"], 0.0);
  EXPECT_LT(json["denoised"]["noise"], json["noise"]);
}

TEST_F(CommandDenoise, ACropStaysInItsPlace) {
  const std::string crop = folder_ / "crop.exr", exr = folder_ / "o.exr", pfm = folder_ / "o.pfm";
  run(render(crop, {"--aov", "denoise", "--crop", "8,4,24,20"}));
  run({"image", "denoise", crop, exr});
  run({"image", "denoise", crop, pfm});
  ASSERT_TRUE(readImageFile(exr).placement);
  EXPECT_EQ(readImageFile(exr).placement->x, 8);
  EXPECT_EQ(readImage(pfm).texels, readImage(exr).texels);
  EXPECT_EQ(readImage(pfm).width, 48);
}

TEST_F(CommandDenoise, OfAFileIsThatOfTheRender) {
  const std::string kept = folder_ / "kept.exr", later = folder_ / "later.exr",
                    again = folder_ / "again.exr", out = folder_ / "out.exr";
  run(render(out, {"--denoise"}));
  run(render(kept, {"--aov", "denoise"}));
  run({"image", "denoise", kept, later});
  run(render(again, {"--denoise", "--aov", "denoise"}));
  run({"image", "denoise", again, again + ".exr"});
  for (const char* name : {"", "noisy", "denoise_error"}) {
    EXPECT_EQ(layer(later, name), layer(out, name)) << name;
    EXPECT_EQ(layer(again, name), layer(out, name)) << name;
    EXPECT_EQ(layer(again + ".exr", name), layer(out, name)) << name;
  }
}

TEST_F(CommandDenoise, KeepsAlpha) {
  const std::string kept = folder_ / "kept.exr", later = folder_ / "later.exr",
                    out = folder_ / "out.exr";
  run(render(kept, {"--transparent", "--aov", "denoise"}));
  run(render(out, {"--transparent", "--denoise"}));
  run({"image", "denoise", kept, later});
  EXPECT_EQ(layer(out, "alpha"), layer(kept, "alpha"));
  EXPECT_EQ(layer(later, "alpha"), layer(kept, "alpha"));
}

TEST_F(CommandDenoise, RefusesWhatItCannotDenoise) {
  const std::string plain = folder_ / "plain.exr", out = folder_ / "out.exr";
  run(render(plain, {"--aov", "albedo,normal"}));
  expectError({"image", "denoise", plain, out}, "render with --aov denoise");
  expectError({"image", "denoise", plain, plain}, "plain.exr");
  expectError({"image", "denoise", plain, folder_ / "out.txt"}, "out.txt");
  expectError({"render", scene("demo"), "--samples", "1", "--denoise", "-o", out},
              "at least 2 samples");
  expectError({"render", scene("terrace"), "--aov", "denoise", "-o", out}, "denoise the render");
  expectError({"render", scene("terrace"), "--two-pass", "--denoise", "-o", out}, "is biased");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CommandDenoise, OfACompositeKeepsBothImages) {
  const std::string out = folder_ / "out.exr", stats = folder_ / "stats.json";
  const std::string said = run({"render", scene("terrace"), "--size", "72x48", "--samples", "16",
                                "--denoise", "--stats", stats, "-o", out});
  EXPECT_NE(said.find("denoised to about"), std::string::npos) << said;
  const std::vector<float> color = layer(out, ""), noisy = layer(out, "noisy");
  EXPECT_NE(color, noisy);
  EXPECT_EQ(layer(out, "denoise_error").size(), 72u * 48);
  int same = 0;  // pixels of the sky
  for (size_t i = 0; i < 72 * 10 * 3; ++i) same += color[i] == noisy[i];
  EXPECT_GT(same, 1000);
  EXPECT_GT(jsonOfFile(stats)["denoised"]["noise"], 0.0);
}

// The picture so far is denoised as that of a finished render is.
TEST_F(SlowCommandDenoise, CtrlCDenoisesWhatThereIs) {
  const std::string out = folder_ / "out.exr", stats = folder_ / "stats.json";
  const CommandResult result =
      runExecutable(render(out, {"--samples", "100000000", "--time", "600", "--denoise", "--stats",
                                 stats, "--progress"}),
                    " samples");  // a pass is done
  EXPECT_EQ(result.status, 130);
  EXPECT_TRUE(result.error.ends_with("samples per pixel, denoised, is saved as " + out + "\n"))
      << result.error;
  EXPECT_NE(layer(out, ""), layer(out, "noisy"));
  EXPECT_EQ(layer(out, "denoise_error").size(), 48u * 32);
  const Metadata header = readExrMetadata(out);
  EXPECT_EQ(std::get<std::string>(header.at("interrupted")), "true");
  EXPECT_EQ(std::get<std::string>(header.at("denoise")), "true");
  EXPECT_EQ(header.count("denoised_noise"), 1u);
  const auto json = jsonOfFile(stats);
  EXPECT_TRUE(json["interrupted"].get<bool>());
  EXPECT_EQ(json["samples_per_pixel"], std::get<int>(header.at("samples")));
  EXPECT_GT(json["denoised"]["noise"], 0.0);
}

// A second Ctrl-C, and SIGTERM, do not wait for the denoiser; what it needs is saved.
TEST_F(SlowCommandDenoise, ASecondCtrlCLeavesWithoutDenoising) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string out = folder_ / "out.exr", later = folder_ / "later.exr";
    const CommandResult result = runExecutable(
        render(out, {"--size", "480x320", "--samples", "100000000", "--time", "600", "--denoise",
                     "--progress"}),
        " samples", signal, {}, signal == SIGINT ? "Ctrl-C again leaves without" : "");
    EXPECT_EQ(result.status, 130);
    EXPECT_TRUE(
        result.error.ends_with("samples per pixel, not denoised, is saved as " + out + "\n"))
        << result.error;
    const Metadata header = readExrMetadata(out);
    EXPECT_EQ(std::get<std::string>(header.at("interrupted")), "true");
    EXPECT_EQ(std::get<std::string>(header.at("denoise")), "false");
    EXPECT_EQ(header.count("denoised_noise"), 0u);
    EXPECT_FALSE(findLayer(readImageFile(out), "noisy"));
    run({"image", "denoise", out, later});
    EXPECT_EQ(layer(later, "noisy"), layer(out, ""));
    EXPECT_NE(layer(later, ""), layer(out, ""));
  }
}

TEST_F(CommandDenoise, OfAPartIsLeftToTheMerge) {
  const CommandResult part =
      runCommand(render(folder_ / "part.exr", {"--denoise", "--shard", "1/2"}));
  EXPECT_NE(part.error.find("chromeball: --denoise: a part is denoised when all are merged"),
            std::string::npos)
      << part.error;
}

// Neither at 4 samples nor at 16 is a figure of what remains above that of the input, and the line
// says the same as the statistics.
TEST_F(CommandDenoise, NoFigureExceedsTheInputs) {
  for (const std::string samples : {"4", "16"}) {
    const std::string out = folder_ / "out.exr", stats = folder_ / "stats.json";
    const std::string said =
        run(render(out, {"--samples", samples, "--denoise", "--stats", stats}));
    const auto json = jsonOfFile(stats);
    EXPECT_LE(json["denoised"]["noise"], json["noise"]);
    EXPECT_LE(json["denoised"]["median"], json["noise_median"]);
    EXPECT_LE(json["denoised"]["p95"], json["noise_p95"]);
    EXPECT_LT(json["denoised"]["p95"], 1.0);
    const Metadata header = readExrMetadata(out);
    EXPECT_NEAR(std::get<float>(header.at("denoised_noise_p95")), json["denoised"]["p95"], 1e-6);
    const auto share = [&](const std::string& before, const std::string& after) {
      const size_t begin = said.find(before) + before.size();
      EXPECT_NE(said.find(after, begin), std::string::npos) << said;
      return 0.01 * std::stod(said.substr(begin));
    };
    const double p95 = json["noise_p95"], median = json["denoised"]["median"];
    EXPECT_NEAR(share("typical pixel, above ", "% in the worst 5%"), p95, 0.006);
    EXPECT_NEAR(share("denoised to about ", "%, and "), median, 0.006);
  }
}

// Files that someone has edited.
TEST_F(CommandDenoise, RefusesDamagedLayers) {
  const std::string kept = folder_ / "kept.exr", out = folder_ / "out.exr";
  run(render(kept, {"--aov", "denoise"}));
  const ImageFile file = readImageFile(kept);
  const auto expectRefused = [&](const std::string& reason, const auto& edit) {
    OutputImage damaged;
    damaged.layers.push_back({"", "RGB", *findColor(file)});
    for (const char* name : {"half", "direct", "direct_half", "albedo", "albedo_half", "normal",
                             "normal_half", "disparity", "disparity_half"}) {
      Image image = *findLayer(file, std::string("denoise.") + name);
      const char* channels = image.channels == 1 ? "Y" : "RGB";
      damaged.layers.push_back({std::string("denoise.") + name, channels, std::move(image)});
    }
    edit(damaged.layers);
    writeImage(folder_ / "damaged.exr", damaged);
    expectError({"image", "denoise", folder_ / "damaged.exr", out}, reason);
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  using Layers = std::vector<Layer>;
  expectRefused("denoise.normal_half", [](Layers& l) { l[7].image.texels[7] = INFINITY; });
  expectRefused("denoise.albedo", [](Layers& l) { l[4].image.texels[7] = 1e30f; });
  expectRefused("denoise.direct", [](Layers& l) { l[2].image.texels[7] = NAN; });
  expectRefused("the colour", [](Layers& l) { l[0].image.texels[0] = -3e38f; });
  expectRefused("no channel R", [](Layers& l) { l[0].channels = "XYZ"; });
  expectRefused("noisy of 3 channels", [](Layers& l) {
    l.push_back({"noisy", "Y", Image(l[0].image.width, l[0].image.height, 1)});
  });
}

}  // namespace
}  // namespace chromeball::command_denoise_test
