// SPDX-License-Identifier: Apache-2.0
// FLIP compared with an independent brute-force implementation of the formulas of the paper, by
// two-dimensional convolution and without shared code.
#include "measure/image_error.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace chromeball::flip_test {
namespace {

constexpr int kWidth = 40, kHeight = 24;

Image reference() {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] =
            float(0.5 + 0.45 * std::sin(0.31 * x + 1.3 * c) * std::cos(0.23 * y - 0.7 * c));
  return image;
}

// The same image with darker, shifted patches.
Image test() {
  Image image = reference();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if ((x / 5 + y / 3) % 3 == 0)
        for (int c = 0; c < 3; ++c)
          image.at(x, y)[c] = std::clamp(0.6f * image.at(x, y)[c] + 0.1f * float(c), 0.0f, 1.0f);
  return image;
}

Image filled(Rgb color) {
  Image image(8, 8, 3);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) image.setRgb(x, y, color);
  return image;
}

double mean(const Image& image) {
  double sum = 0;
  for (const float number : image.texels) sum += number;
  return sum / double(image.texels.size());
}

TEST(Flip, agreesWithBruteForce) {
  const Image error = flip(reference(), test());
  EXPECT_NEAR(mean(error), 0.24528596722301538, 1e-6);
  EXPECT_NEAR(*error.at(3, 2), 0.46788524570395484, 1e-5);
  EXPECT_NEAR(*error.at(20, 11), 0.2325681061383163, 1e-5);
  EXPECT_NEAR(*error.at(39, 23), 0.057411214656086215, 1e-5);
}

// Uniform images differ in colour only. Black and white differ by 100 in lightness, which the
// compression of section 4.1 of the paper maps to this number.
TEST(Flip, blackAndWhite) {
  EXPECT_NEAR(mean(flip(filled(Rgb(0)), filled(Rgb(1)))), 0.9673797614921327, 1e-6);
  EXPECT_NEAR(mean(flip(filled({0, 1, 0}), filled({0, 0, 1}))), 1, 1e-6);
}

TEST(Flip, equalImagesDoNotDiffer) {
  EXPECT_EQ(mean(flip(reference(), reference())), 0);
  EXPECT_EQ(mean(hdrFlip(reference(), reference())), 0);
}

// HDR-FLIP derives its exposures from the reference, so a common factor changes nothing. It detects
// differences in highlights that are clipped without exposure.
TEST(Flip, hdrCoversAllExposures) {
  Image bright = reference(), off = test();
  const double before = mean(hdrFlip(bright, off));
  for (float& number : bright.texels) number *= 64;
  for (float& number : off.texels) number *= 64;
  EXPECT_NEAR(mean(hdrFlip(bright, off)), before, 1e-5);

  Image lamp = filled(Rgb(0.2f)), brighter = lamp;
  lamp.setRgb(4, 4, Rgb(100));
  brighter.setRgb(4, 4, Rgb(50));
  EXPECT_LT(mean(flip(lamp, brighter)), 1e-6) << "both are clipped";
  EXPECT_GT(mean(hdrFlip(lamp, brighter)), 0.01);
}

TEST(Flip, sizesMustAgree) { EXPECT_THROW(flip(reference(), filled(Rgb(0))), InputError); }

}  // namespace
}  // namespace chromeball::flip_test
