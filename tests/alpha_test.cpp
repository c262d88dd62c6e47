// SPDX-License-Identifier: Apache-2.0
// Alpha of images: associated (premultiplied) in memory and in EXR, straight in PNG.
#include <gtest/gtest.h>

#include "base/file.h"
#include "gltf_writer.h"
#include "image/io/decode_image.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::alpha_test {
namespace {

using Words = std::vector<std::string>;

// Radiance 0.25, 0.5 and 1 with alpha from 0 to 1.
Image ramp() {
  Image image(9, 1, 4);
  for (int x = 0; x < image.width; ++x) {
    const float alpha = float(x) / 8;
    image.setRgb(x, 0, alpha * Rgb(0.25f, 0.5f, 1));
    image.at(x, 0)[3] = alpha;
  }
  return image;
}

void expectStraight(const std::string& path, const DisplayTransform& transform) {
  const DecodedImage png = decodeImage(readFile(path), path);
  ASSERT_EQ(png.texels8.size(), 9u);
  const Rgb shown = display(transform, Rgb(0.25f, 0.5f, 1));
  for (int x = 0; x < 9; ++x) {
    EXPECT_EQ(png.texels8[size_t(x)][3], std::lround(255 * x / 8.0)) << x;
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(png.texels8[size_t(x)][size_t(c)],
                x == 0 ? 0 : std::lround(255 * linearToSrgb(shown[c])))
          << x;
  }
}

TEST(Alpha, PngStoresStraightAlphaWithEveryToneCurve) {
  const TemporaryFolder folder;
  for (const char* tone : {"none", "reinhard", "aces", "neutral", "filmic"}) {
    const DisplayTransform transform{parseToneOperator(tone), -0.5f};
    writeImage(folder / "a.png", ramp(), transform);
    expectStraight(folder / "a.png", transform);
  }
}

TEST(Alpha, ViewPreservesAlpha) {
  const TemporaryFolder folder;
  writeImage(folder / "a.exr", ramp());
  EXPECT_EQ(
      runCommand({"image", "view", folder / "a.exr", folder / "a.png", "--exposure", "0"}).status,
      0);
  expectStraight(folder / "a.png", {});
  // Viewing the output again gives the same image.
  EXPECT_EQ(runCommand({"image", "view", folder / "a.png", folder / "b.png"}).status, 0);
  expectStraight(folder / "b.png", {});
}

TEST(Alpha, PngIsAssociatedInLinearLight) {
  const TemporaryFolder folder;
  writeImage(folder / "a.png", ramp());
  const ImageFile file = readImageFile(folder / "a.png");
  ASSERT_EQ(file.image.channels, 4);
  for (int x = 0; x < 9; ++x)
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(file.image.at(x, 0)[c], ramp().at(x, 0)[c], 0.006) << x << ' ' << c;
  EXPECT_EQ(findColor(file)->channels, 3);
  EXPECT_EQ(findColorAndAlpha(file)->channels, 4);
}

// A matte wall of albedo 1/2 under radiance 2 has radiance 1. It covers the left of the image and
// two fifths of the fifth pixel column.
TEST(Alpha, TransparentRendersHaveTheCoverageOfEachPixel) {
  GltfWriter model;
  model.add("materials", {{"pbrMetallicRoughness",
                           {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}}},
                          {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
  model.root["extensionsUsed"] = {"KHR_materials_specular"};
  const int corners = model.vec3s({-9, -9, 0, 0.1f, -9, 0, 0.1f, 9, 0, -9, 9, 0});
  model.add("nodes", {{"mesh", model.mesh({{"attributes", {{"POSITION", corners}}},
                                           {"indices", model.indices({0, 1, 2, 0, 2, 3})},
                                           {"material", 0}})}});
  model.add("cameras", {{"type", "orthographic"},
                        {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 9}}}});
  model.add("nodes", {{"camera", 0}, {"translation", {0, 0, 2}}});
  const TemporaryFolder out;
  writeImage(out / "probe.exr", constantProbe({8, 4}, Rgb(2)));
  const CommandResult result =
      runCommand({"render", model.save(), "--probe", out / "probe.exr", "--transparent", "--size",
                  "8x8", "--samples", "1024", "--exposure", "0", "--quiet", "-o", out / "a.exr",
                  "-o", out / "a.png", "-o", out / "a.pfm"});
  ASSERT_EQ(result.status, 0) << result.error;
  const ImageFile exr = readImageFile(out / "a.exr");
  const Image color = *findColorAndAlpha(exr), flat = readImage(out / "a.pfm");
  const DecodedImage png = decodeImage(readFile(out / "a.png"), "a.png");
  ASSERT_EQ(color.channels, 4);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const float coverage = x < 4 ? 1 : x > 4 ? 0 : 0.4f;
      EXPECT_NEAR(color.at(x, y)[3], coverage, 0.01) << x << ' ' << y;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(color.at(x, y)[c], color.at(x, y)[3], 0.03) << x << ' ' << y;
        EXPECT_EQ(flat.at(x, y)[c], color.at(x, y)[c]);
      }
      const auto texel = png.texels8[size_t(8 * y + x)];
      EXPECT_NEAR(texel[3], 255 * coverage, 3);
      EXPECT_NEAR(texel[0], x > 4 ? 0 : 255, 4);
    }
}

}  // namespace
}  // namespace chromeball::alpha_test
