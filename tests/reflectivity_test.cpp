// SPDX-License-Identifier: Apache-2.0
// Reflectivity from two rectangles of a photograph.
#include "probe/capture/reflectivity.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "base/error.h"
#include "probe/synth.h"

namespace chromeball::reflectivity_test {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// Normal noise of standard deviation `sigma` around `mean`.
Image noisy(int width, int height, const glm::dvec3& mean, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma);
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.setRgb(x, y, Rgb(mean + glm::dvec3(noise(random), noise(random), noise(random))));
  return image;
}

TEST(Reflectivity, MeanOfAPatch) {
  Image image(4, 3, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) image.setRgb(x, y, Rgb(float(x), float(y), 1));
  const PatchMean patch = patchMean(image, {1, 0, 2, 3}, kUnlimited, "x");
  EXPECT_EQ(patch.pixels, 6u);
  EXPECT_EQ(patch.mean, glm::dvec3(1.5, 1, 1));
  // Three of each of 1 and 2: variance 0.3; two of each of 0, 1, 2: 0.8.
  EXPECT_NEAR(patch.standardError.x, std::sqrt(0.3 / 6), 1e-15);
  EXPECT_NEAR(patch.standardError.y, std::sqrt(0.8 / 6), 1e-15);
  EXPECT_EQ(patch.standardError.z, 0);
  EXPECT_THROW(patchMean(image, {0, 0, 1, 1}, kUnlimited, "x"), InputError);
}

// Over many photographs the ratio is within its standard errors as often as a normal variable is.
TEST(Reflectivity, StandardErrorIsThatOfTheRatio) {
  const glm::dvec3 truth(0.632, 0.647, 0.59), light(2, 1.5, 1);
  int within = 0;
  double squares = 0;
  constexpr unsigned kTrials = 400;
  for (unsigned i = 0; i < kTrials; ++i) {
    const PatchMean direct =
        patchMean(noisy(12, 10, light, 0.1, 2 * i), {0, 0, 12, 10}, kUnlimited, "x");
    const PatchMean reflected =
        patchMean(noisy(8, 8, truth * light, 0.1, 2 * i + 1), {0, 0, 8, 8}, kUnlimited, "x");
    const Reflectivity result = reflectivity(reflected, direct, glm::dvec3(1), "x");
    const double z = (result.value.x - truth.x) / result.standardError.x;
    within += std::fabs(z) < 1;
    squares += z * z;
  }
  // 68.3% +- 2.3%, 4 standard errors; the mean of z^2 is 1 +- sqrt(2 / 400).
  EXPECT_NEAR(double(within) / kTrials, 0.683, 0.093);
  EXPECT_NEAR(squares / kTrials, 1, 0.29);
}

TEST(Reflectivity, OfAPaintBesideAStandard) {
  const PatchMean paint{glm::dvec3(0.2, 0.3, 0.4), glm::dvec3(0), 1};
  const PatchMean standard{glm::dvec3(0.5), glm::dvec3(0), 1};
  const Reflectivity result = reflectivity(paint, standard, glm::dvec3(0.9), "x");
  EXPECT_LT(glm::distance(result.value, glm::dvec3(0.36, 0.54, 0.72)), 1e-15);
  EXPECT_EQ(result.standardError, glm::dvec3(0));
  EXPECT_THROW(reflectivity(paint, {glm::dvec3(1, 0, 1), glm::dvec3(0), 1}, glm::dvec3(1), "x"),
               InputError);
}

TEST(Reflectivity, RefusesWhatIsNoRadiance) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {std::nanf(""), inf, -inf, -0.1f, 1.f, 70000.f}) {
    Image image = constantProbe({8, 8}, Rgb(0.5f));
    image.at(3, 3)[1] = bad;
    EXPECT_THROW(patchMean(image, {2, 2, 4, 4}, 1, "x"), InputError) << bad;
    EXPECT_NO_THROW(patchMean(image, {4, 2, 4, 4}, 1, "x"));
  }
}

TEST(Reflectivity, Rectangles) {
  const PixelRectangle r = parseRectangle("1,2,30,4", "x");
  EXPECT_EQ(r.x, 1);
  EXPECT_EQ(r.y, 2);
  EXPECT_EQ(r.width, 30);
  EXPECT_EQ(r.height, 4);
  for (const char* wrong : {"", "1", "1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,-4", "1.5,2,3,4",
                            "1,2,3,4 ", "a,b,c,d", "1,2,3,99999999999", "1;2;3;4"})
    EXPECT_THROW(parseRectangle(wrong, "x"), InputError) << wrong;
  const Image image = constantProbe({8, 4}, Rgb(1));
  for (const PixelRectangle& outside :
       {PixelRectangle{-1, 0, 2, 2}, PixelRectangle{0, -1, 2, 2}, PixelRectangle{7, 0, 2, 2},
        PixelRectangle{0, 3, 2, 2}, PixelRectangle{0, 0, 2147483647, 2147483647}})
    EXPECT_THROW(patchMean(image, outside, kUnlimited, "x"), InputError);
}

}  // namespace
}  // namespace chromeball::reflectivity_test
