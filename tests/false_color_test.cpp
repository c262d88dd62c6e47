// SPDX-License-Identifier: Apache-2.0
// False colours, and encoding of PNGs in memory.
#include "measure/false_color.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "run_command.h"

namespace chromeball::false_color_test {
namespace {

double grey(const Color8& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(FalseColor, luminanceOfHeatIncreases) {
  for (int i = 1; i <= 255; ++i)
    EXPECT_GE(grey(heatColor(i / 255.0)), grey(heatColor((i - 1) / 255.0))) << i;
  EXPECT_LT(grey(heatColor(0)), 5);
  EXPECT_GT(grey(heatColor(1)), 240);
  EXPECT_EQ(heatColor(std::nan("")), heatColor(0));
  EXPECT_EQ(heatColor(7), heatColor(1));
}

TEST(FalseColor, signedColorsAreWhiteAtZero) {
  EXPECT_EQ(signedColor(0), (Color8{247, 247, 247}));
  EXPECT_GT(signedColor(0.7)[0], signedColor(0.7)[2]) << "positive is red";
  EXPECT_LT(signedColor(-0.7)[0], signedColor(-0.7)[2]) << "negative is blue";
}

TEST(FalseColor, scales) {
  EXPECT_EQ(logLevel(0, 1, 3), 0);
  EXPECT_NEAR(logLevel(0.1, 10, 4), 0.5, 1e-12);
  EXPECT_EQ(logLevel(20, 10, 4), 1);
  EXPECT_EQ(roundUp(0.031), 0.05);
  EXPECT_NEAR(roundUp(712), 1000, 1e-9);
  EXPECT_EQ(percentile({3, 1, NAN, 2}, 1), 3);
  EXPECT_EQ(percentile({3, 1, NAN, 2}, 0.5), 2);
  EXPECT_EQ(percentile({}, 0.5), 0);
}

TEST(EncodePng, isLossless) {
  for (const int channels : {1, 3}) {
    std::vector<uint8_t> bytes(256 * size_t(channels));
    for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = uint8_t(i * 7);
    const std::vector<uint8_t> png = encodePng(32, 8, channels, bytes);
    const TemporaryFolder folder;
    std::ofstream(folder / "a.png", std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), std::streamsize(png.size()));
    const ImageFile file = readImageFile(folder / "a.png", IntegerTexels::Linear);
    ASSERT_EQ(file.image.texels.size(), bytes.size());
    for (size_t i = 0; i < bytes.size(); ++i)
      EXPECT_EQ(std::lround(255 * file.image.texels[i]), bytes[i]) << i;
  }
}

}  // namespace
}  // namespace chromeball::false_color_test
