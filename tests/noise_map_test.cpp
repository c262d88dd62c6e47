// SPDX-License-Identifier: Apache-2.0
// Where an image is noisy, in words and as a picture.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "measure/false_color.h"

namespace chromeball::noise_map_test {
namespace {

// Errors of 1%, and of 20% in a rectangle.
Image errors(int width, int height, int left, int top, int right, int bottom) {
  Image image(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      *image.at(x, y) = x >= left && x < right && y >= top && y < bottom ? 0.2f : 0.01f;
  return image;
}

TEST(NoiseMap, NamesTheSmallestPartThatHasMostOfTheNoise) {
  EXPECT_EQ(noisiestPart(errors(90, 60, 0, 0, 12, 10)), "upper left");
  EXPECT_EQ(noisiestPart(errors(90, 60, 40, 25, 50, 35)), "middle");
  EXPECT_EQ(noisiestPart(errors(90, 60, 80, 50, 90, 60)), "lower right");
  EXPECT_EQ(noisiestPart(errors(90, 60, 0, 58, 90, 60)), "lower third");
  EXPECT_EQ(noisiestPart(errors(90, 60, 88, 0, 90, 60)), "right third");
  EXPECT_EQ(noisiestPart(errors(90, 60, 0, 19, 90, 21)), "upper part");
}

TEST(NoiseMap, NoiseAllOverHasNoPlace) {
  Image even = errors(90, 60, 0, 0, 0, 0);
  EXPECT_EQ(noisiestPart(even), "");
  for (size_t i = 0; i < even.texels.size(); i += 23) even.texels[i] = 0.3f;
  EXPECT_EQ(noisiestPart(even), "");
  EXPECT_EQ(noisiestPart({}), "");
  for (float& error : even.texels) error = NAN;
  EXPECT_EQ(noisiestPart(even), "");
}

TEST(NoiseMap, IsSmallAndLogarithmic) {
  Image image = errors(1000, 500, 0, 0, 500, 500);
  for (int x = 996; x < 1000; ++x)
    for (int y = 0; y < 500; ++y) *image.at(x, y) = NAN;
  const NoiseMap map = noiseMap(image);
  EXPECT_EQ(map.width, 250);
  EXPECT_EQ(map.height, 125);
  ASSERT_EQ(map.bytes.size(), 3u * 250 * 125);
  const auto color = [&](int x, int y) {
    const size_t i = 3 * size_t(y * map.width + x);
    return Color8{map.bytes[i], map.bytes[i + 1], map.bytes[i + 2]};
  };
  EXPECT_EQ(color(10, 60), heatColor((3 + std::log10(0.2)) / 3));
  EXPECT_EQ(color(200, 60), heatColor(1.0 / 3));
  EXPECT_EQ(color(249, 60), (Color8{128, 128, 128}));
}

// A square of pixels counts by the mean of its squares.
TEST(NoiseMap, SquaresOfPixelsAddTheirSquares) {
  Image image(640, 2, 1);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = i % 2 ? 0.4f : 0.0f;
  const NoiseMap map = noiseMap(image);
  ASSERT_EQ(map.width, 320);
  EXPECT_EQ((Color8{map.bytes[0], map.bytes[1], map.bytes[2]}),
            heatColor(1 + std::log10(0.4 / std::sqrt(2)) / 3));
  EXPECT_EQ(noiseMap(Image(320, 200, 1)).width, 320);
}

}  // namespace
}  // namespace chromeball::noise_map_test
