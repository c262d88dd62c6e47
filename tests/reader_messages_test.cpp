// SPDX-License-Identifier: Apache-2.0
// The messages of readers and writers of images reach the user of every command.
#include <gtest/gtest.h>

#include <fstream>

#include "image/io/write_image.h"
#include "run_command.h"

namespace chromeball::reader_messages_test {
namespace {

using Words = std::vector<std::string>;

class SlowReaderMessages : public testing::Test {
 protected:
  static constexpr int kSide = 16;

  SlowReaderMessages() {
    Image image(kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) image.setRgb(x, y, Rgb(0.1f + 0.05f * float(x + y % 3)));
    writeImage(plain(), image);
    // Its header has a field that the reader applies, and notes.
    std::ofstream file(noted(), std::ios::binary);
    file << "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 16 +X 16\n";
    for (int y = 0; y < kSide; ++y) {
      file << '\2' << '\2' << '\0' << char(kSide);
      for (int c = 0; c < 4; ++c) {
        file << char(kSide);
        for (int x = 0; x < kSide; ++x) file << (c == 3 ? char(128) : char(20 + 5 * x + y % 3));
      }
    }
  }

  std::string plain() const { return folder_ / "plain.exr"; }
  std::string noted() const { return folder_ / "noted.hdr"; }
  std::string out(const char* extension) const { return folder_ / std::string("out") + extension; }
  std::string text(const char* name, const std::string& contents) const {
    std::ofstream(folder_ / name) << contents;
    return folder_ / name;
  }

  TemporaryFolder folder_;
};

// `image denoise` is left out: it says instead that this file has no layers to denoise.
TEST_F(SlowReaderMessages, OfEveryCommandThatReadsAnImage) {
  const std::string a = noted(), b = plain(), exr = out(".exr"), png = out(".png");
  const std::string tiles = text(
      "tiles.toml", "fov = 90\n[[tile]]\nfile = \"noted.hdr\"\nyaw = 0\npitch = 0\nroll = 0\n");
  const std::string list = text("list.csv", "noted.hdr,0,0,1\nplain.exr,0,1,0\n");
  const std::string folder = std::filesystem::path(a).parent_path().string();
  const std::vector<Words> commands = {
      {"image", "view", a, png},
      {"image", "view", a, png, "--layer", "R"},
      {"image", "error", a, b},
      {"image", "error", b, a},
      {"image", "develop", a, png},
      {"image", "develop", b, png, "--vignette", a},
      {"image", "divide", a, b, "-o", exr},
      {"image", "divide", b, a, "-o", exr},
      {"image", "relight", a, "--gain", "sun=1", "-o", exr},
      {"image", "flat-field", a, a, a, a, "-o", exr},
      {"lights", a, "--method", "median-cut", "--count", "4", "-o", out(".json")},
      {"probe", "info", a},
      {"probe", "convert", a, exr, "--to", "lat-long"},
      {"probe", "edit", a, exr, "--scale", "2"},
      {"probe", "irradiance", a, exr},
      {"probe", "rays", a},
      {"probe", "plot", a, out(".svg")},
      {"probe", "convolve", a, exr, "--kernel", "diffuse"},
      {"probe", "align", a, b},
      {"probe", "align", b, a},
      {"probe", "split", a, "--suns", out(".json"), "--rest", exr},
      {"probe", "merge", a, b, "--exposures", "1,0.5", "--unaligned", "-o", exr},
      {"probe", "merge", b, b, "--exposures", "1,0.5", "--flat-field", a, "-o", exr},
      {"probe", "merge", "--calibrate-filter", a, b},
      {"probe", "assemble", a, "--circle", "8,8,7", "-o", exr},
      {"probe", "assemble", b, "--circle", "8,8,7", "--mask", a, "-o", exr},
      {"probe", "assemble", b, "--circle", "8,8,7", "--fill", a, "-o", exr},
      {"probe", "reflectivity", a, "--direct", "0,0,3,3", "--reflected", "8,8,3,3"},
      {"probe", "reflectivity", b, "--direct", "0,0,3,3", "--against", a, "--reflected", "8,8,3,3"},
      {"probe", "sun", a, "--diffuse", b, "--circle", "8,8,8", "--paint", "0.5", "--camera", "0,0"},
      {"probe", "sun", b, "--diffuse", a, "--circle", "8,8,8", "--paint", "0.5", "--camera", "0,0"},
      {"probe", "stitch", tiles, "-o", exr},
      {"relight", "--images", folder, "--directions", list, "--probe", b, "-o", exr},
  };
  for (const Words& words : commands) {
    const std::string error = runCommand(words).error;
    EXPECT_NE(error.find(a + ": its texels are divided by EXPOSURE=2"), std::string::npos)
        << testing::PrintToString(words) << "\n"
        << error;
  }
}

// If a .hdr states primaries, the colour is converted and the user told.
TEST_F(SlowReaderMessages, OfPrimaries) {
  std::string contents = fileContents(noted());
  const std::string field = "PRIMARIES=.708 .292 .170 .797 .131 .046 .3127 .329\n";
  contents.replace(contents.find("EXPOSURE=2\n"), 11, field);
  std::ofstream(folder_ / "wide.hdr", std::ios::binary) << contents;
  const std::string error = runCommand({"image", "view", folder_ / "wide.hdr", out(".png")}).error;
  EXPECT_NE(error.find("its colour is converted to Rec. 709 from red (0.708, 0.292)"),
            std::string::npos)
      << error;
}

// Warnings about data that a format cannot hold, wherever an image is written.
TEST_F(SlowReaderMessages, OfLostLight) {
  Image negative(kSide, kSide, 3), uncovered(kSide, kSide, 4);
  for (float& texel : negative.texels) texel = 0.5f;
  negative.at(3, 3)[1] = -0.5f;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) uncovered.setRgb(x, y, Rgb(2));
  const std::string n = folder_ / "negative.exr", u = folder_ / "uncovered.exr";
  writeImage(n, negative), writeImage(u, uncovered);
  for (const char* kind : {".png", ".hdr", ".exr"}) {
    const bool loses = std::string(kind) != ".exr", isPng = std::string(kind) == ".png";
    for (const Words& words : std::vector<Words>{{"image", "develop", n, out(kind)},
                                                 {"image", "divide", n, plain(), "-o", out(kind)}})
      EXPECT_EQ(runCommand(words).error.find("are negative, down to -") != std::string::npos, loses)
          << testing::PrintToString(words);
    const std::string error = runCommand({"image", "develop", u, out(kind)}).error;
    EXPECT_EQ(error.find("loses light on 1e+02% of the pixels") != std::string::npos, isPng)
        << error;
  }
  EXPECT_NE(runCommand({"image", "view", n, out(".png")}).error.find("are negative"),
            std::string::npos);
}

}  // namespace
}  // namespace chromeball::reader_messages_test
