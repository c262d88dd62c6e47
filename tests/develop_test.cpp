// SPDX-License-Identifier: Apache-2.0
// The optics of image/develop/: closed forms, and the fast filters against the exact ones.
#include "image/develop/develop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "image/develop/bloom.h"
#include "image/develop/lens.h"

namespace chromeball::develop_test {
namespace {

Image filled(int width, int height, float number) {
  Image image(width, height, 3);
  std::ranges::fill(image.texels, number);
  return image;
}

// Black, with a square of side `a` in the middle; odd sizes.
Image square(int size, int a, float radiance) {
  Image image(size, size, 3);
  for (int y = (size - a) / 2; y < (size + a) / 2; ++y)
    for (int x = (size - a) / 2; x < (size + a) / 2; ++x) image.setRgb(x, y, Rgb(radiance));
  return image;
}

float centre(const Image& image) { return image.rgb(image.width / 2, image.height / 2).y; }

double sum(const Image& image) {
  double total = 0;
  for (const float texel : image.texels) total += double(texel);
  return total;
}

double maximum(const Image& image) {
  return double(*std::max_element(image.texels.begin(), image.texels.end()));
}

double largestDifference(const Image& a, const Image& b) {
  double largest = 0;
  for (size_t i = 0; i < a.texels.size(); ++i)
    largest = std::max(largest, std::fabs(double(a.texels[i]) - double(b.texels[i])));
  return largest;
}

Image blurred(Image image, double sigma, GaussianMethod method = GaussianMethod::Fast) {
  blurGaussian(image, sigma, method);
  return image;
}

// HDRI book, figure 9.5: two squares of sides 2 sigma, 1.5 and 6 times white.
TEST(Develop, BlurredSquaresOfDifferentRadiance) {
  for (const double sigma : {0.5, 2.5, 7.5, 12.5, 40.5}) {
    const int a = int(2 * sigma), size = 12 * a + 1 + (a % 2 == 0);
    const double peak = std::pow(std::erf(a / (2 * std::sqrt(2.0) * sigma)), 2);
    EXPECT_NEAR(centre(blurred(square(size, a, 1.5f), sigma)), 1.5 * peak, 1.5e-3) << sigma;
    EXPECT_NEAR(centre(blurred(square(size, a, 6), sigma)), 6 * peak, 6e-3) << sigma;
  }
  EXPECT_NEAR(centre(blurred(square(201, 15, 1.5f), 7.5)), 0.699, 1e-3) << "below white";
  EXPECT_NEAR(centre(blurred(square(201, 15, 6), 7.5)), 2.80, 5e-3) << "above white";
}

TEST(Develop, GaussianKeepsTheSum) {
  for (const double sigma : {0.01, 0.3, 3.0, 8.0, 8.1, 32.0, 128.0, 4096.0})
    for (const int x : {0, 1, 37, 62}) {  // mirrored borders
      Image image(63, 45, 3);
      image.setRgb(x, 20, Rgb(1e4f));
      EXPECT_NEAR(sum(blurred(image, sigma)), 3e4, 0.3) << sigma << " " << x;
    }
}

TEST(Develop, SigmaZeroChangesNothing) {
  const Image image = square(9, 3, 2);
  EXPECT_EQ(blurred(image, 0).texels, image.texels);
  EXPECT_EQ(blurred(image, 1e-3).texels, image.texels);
}

// Compares blurs of one bright pixel, the hardest image, at each offset from the reduced pixels,
// relative to the largest pixel of the exact blur; and blurs of a step.
TEST(Develop, FastGaussianEqualsTheExactOne) {
  double worst = 0;
  for (const double sigma : {8.5, 11.0, 15.9, 16.0, 31.0, 32.0, 50.0})
    for (const int offset : {0, 1, 3, 7, 100}) {
      Image dot(401, 3, 3), step(401, 3, 3);
      dot.setRgb(200 + offset, 1, Rgb(1));
      for (int x = 200 + offset; x < 401; ++x)
        for (int y = 0; y < 3; ++y) step.setRgb(x, y, Rgb(1));
      for (const Image& image : {dot, step}) {
        const Image exact = blurred(image, sigma, GaussianMethod::Exact);
        worst = std::max(worst, largestDifference(blurred(image, sigma), exact) / maximum(exact));
      }
    }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 0.0005) << "a tenth of the 0.5% that are promised";
}

// "A Gaussian blur can be closely approximated as several successive box blurs" (section 9.2.5).
TEST(Develop, BoxesApproximateAGaussian) {
  constexpr double kSigma = 12;
  Image boxes(201, 5, 3);
  for (int y = 0; y < 5; ++y)
    for (int x = 100; x < 201; ++x) boxes.setRgb(x, y, Rgb(6));
  const Image exact = blurred(boxes, kSigma, GaussianMethod::Exact);
  const double length = std::sqrt(12 * (kSigma * kSigma + 1.0 / 12) / 4);
  for (int i = 0; i < 4; ++i) boxes = blurMotion(boxes, {length, 0});
  EXPECT_LT(largestDifference(boxes, exact), 0.01 * 6);
}

TEST(Develop, BloomIsTheSumOfItsParts) {
  Image image = square(65, 3, 1000);
  const Image result = bloom(image, {{0.75, 1}, {0.25, 12}}, GaussianMethod::Exact);
  const float expected =
      0.75f * centre(blurred(image, 1)) + 0.25f * centre(blurred(image, 12, GaussianMethod::Exact));
  EXPECT_NEAR(centre(result), expected, 1e-4 * expected);
  EXPECT_NEAR(sum(result) / sum(image), 1, 1e-5);
}

// Figure 9.6: a lamp of 100 times white and its clipped image.
TEST(Develop, StreakOfALampStaysWhite) {
  Image lamp(201, 21, 3);
  lamp.setRgb(100, 10, Rgb(100));
  DevelopSettings settings{.motion = Motion{60, 0}};
  Image hdr = lamp, ldr = lamp;
  develop(hdr, settings, nullptr, {});
  settings.clip = 1.0f;
  develop(ldr, settings, nullptr, {});
  for (int x = 71; x < 130; ++x) {
    EXPECT_NEAR(hdr.rgb(x, 10).x, 100.0 / 60, 1e-5);
    EXPECT_NEAR(ldr.rgb(x, 10).x, 1.0 / 60, 1e-7);
  }
  EXPECT_NEAR(hdr.rgb(70, 10).x, 50.0 / 60, 1e-5) << "half of the box's last pixel";
  EXPECT_EQ(hdr.rgb(69, 10).x, 0);
  EXPECT_EQ(hdr.rgb(100, 11).x, 0);
  EXPECT_NEAR(sum(hdr), 300, 3e-3);
}

TEST(Develop, StreaksOfAllAnglesKeepTheSumAndTheirDirection) {
  for (const double angle : {0.0, 17.0, 45.0, 90.0, 135.0, -30.0, 360.0}) {
    Image lamp(101, 101, 3);
    lamp.setRgb(50, 50, Rgb(100));
    const Image streak = blurMotion(lamp, {40, angle});
    EXPECT_NEAR(sum(streak), 300, 3e-3) << angle;
    // The second moment along the segment is L^2 / 12; across it, that of linear interpolation.
    const double c = std::cos(angle * kPiD / 180), s = std::sin(angle * kPiD / 180);
    double along = 0, across = 0;
    for (int y = 0; y < 101; ++y)
      for (int x = 0; x < 101; ++x) {
        const double weight = double(streak.rgb(x, y).x) / 100, u = x - 50, v = 50 - y;
        along += weight * std::pow(c * u + s * v, 2);
        across += weight * std::pow(c * v - s * u, 2);
      }
    EXPECT_NEAR(along, 40 * 40 / 12.0, 0.6) << angle;
    EXPECT_LT(across, 0.3) << angle;
    Image border(64, 32, 3);
    border.setRgb(0, 16, Rgb(100));
    EXPECT_NEAR(sum(blurMotion(border, {20, angle})), 300, 3e-3) << angle;
    EXPECT_LT(largestDifference(blurMotion(filled(30, 20, 2), {50, angle}), filled(30, 20, 2)),
              1e-6);
  }
}

TEST(Develop, ShortMotionChangesNothing) {
  const Image image = square(9, 3, 2);
  EXPECT_EQ(blurMotion(image, {0, 30}).texels, image.texels);
  EXPECT_EQ(blurMotion(image, {1, 90}).texels, image.texels);
}

TEST(Develop, VignetteIsThatOfAThinLens) {
  Image image = filled(300, 200, 2);
  vignette(image, 0.4, {0, 0, 300, 200, 60});
  const double size = std::tan(kPiD / 6) / 100;  // of a pixel
  const double tan2 = size * size * (149.5 * 149.5 + 99.5 * 99.5);
  const double expected = 2 * (1 - 0.4 * (1 - 1 / std::pow(1 + tan2, 2)));
  for (const auto& [x, y] : {std::pair(0, 0), {299, 0}, {0, 199}, {299, 199}})
    EXPECT_NEAR(image.rgb(x, y).x, expected, 1e-6);
  EXPECT_NEAR(image.rgb(150, 100).x, 2, 1e-4);
  // A part of the picture darkens like the whole.
  Image part = filled(20, 10, 2);
  vignette(part, 0.4, {280, 190, 300, 200, 60});
  EXPECT_EQ(part.rgb(19, 9), image.rgb(299, 199));
}

TEST(Develop, VignetteByAnImage) {
  Image falloff(2, 1, 1);
  falloff.texels = {1, 0.5f};
  Image image = filled(8, 4, 2);
  multiplyFalloff(image, falloff, {0, 0, 8, 4, 0});
  EXPECT_EQ(image.rgb(0, 0), Rgb(2));
  EXPECT_EQ(image.rgb(7, 3), Rgb(1));
  EXPECT_NEAR(image.rgb(3, 1).x + image.rgb(4, 1).x, 3, 1e-6);
}

Image depthOf(int width, int height, float left, float right) {
  Image depth(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) *depth.at(x, y) = x < width / 2 ? left : right;
  return depth;
}

TEST(Develop, ConfusionOfAThinLens) {
  const ViewFrame frame{0, 0, 300, 200, 90};  // a pixel is 1/100 of the distance
  EXPECT_EQ(confusionRadius({2, 0.1}, 2, frame), 0);
  EXPECT_NEAR(confusionRadius({2, 0.1}, 4, frame), 0.05 * 0.5 / (2 * 0.01), 1e-9);
  EXPECT_NEAR(confusionRadius({2, 0.1}, 1e10, frame), 0.05 / (2 * 0.01), 1e-6);
  EXPECT_NEAR(confusionRadius({2, 0.1}, 1, frame), 0.05 / (2 * 0.01), 1e-9);
  EXPECT_EQ(confusionRadius({2, 0.1}, 1e-9, frame), kMaxConfusionRadius);
  EXPECT_EQ(confusionRadius({2, 0.1}, std::nan(""), frame), 0);
}

TEST(Develop, DepthBlurKeepsConstantImages) {
  const Image image = filled(64, 40, 3);
  const Image depth = depthOf(64, 40, 1, 9);
  const Image result = blurByDepth(image, depth, {2, 0.2}, {0, 0, 64, 40, 60});
  EXPECT_LT(largestDifference(result, image), 1e-5);
}

TEST(Develop, DepthBlurLeavesWhatIsInFocus) {
  Image image(64, 40, 3);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = float((i * 7919) % 1000);
  const ViewFrame frame{0, 0, 64, 40, 60};
  EXPECT_EQ(blurByDepth(image, depthOf(64, 40, 2, 2), {2, 0.2}, frame).texels, image.texels);
  // Left in focus, right further away: the left half keeps its bits, the right half is smooth.
  const Image behind = blurByDepth(image, depthOf(64, 40, 2, 20), {2, 0.4}, frame);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 32; ++x) EXPECT_EQ(behind.rgb(x, y), image.rgb(x, y));
  EXPECT_NEAR(behind.rgb(50, 20).x, 500, 150);
  // Right nearer: it is blurred over the edge of the left half.
  Image edge(64, 40, 3);
  for (int y = 0; y < 40; ++y)
    for (int x = 32; x < 64; ++x) edge.setRgb(x, y, Rgb(1));
  const Image before = blurByDepth(edge, depthOf(64, 40, 2, 1), {2, 0.4}, frame);
  EXPECT_GT(before.rgb(31, 20).x, 0.2f);
  EXPECT_GT(before.rgb(29, 20).x, 0);
  EXPECT_EQ(before.rgb(5, 20).x, 0);
}

// A dot on a plane out of focus becomes a disc of the circle of confusion, with its sum.
TEST(Develop, DepthBlurOfADot) {
  Image dot(81, 81, 3);
  dot.setRgb(40, 40, Rgb(1000));
  const ViewFrame frame{0, 0, 81, 81, 60};
  const ThinLens lens{2, 0.5};
  const double radius = confusionRadius(lens, 4, frame);
  const Image disc = blurByDepth(dot, depthOf(81, 81, 4, 4), lens, frame);
  EXPECT_NEAR(sum(disc), 3000, 30);
  EXPECT_NEAR(centre(disc), 1000 / (kPiD * radius * radius), 0.05 * centre(disc));
  EXPECT_GT(disc.rgb(40 + int(radius) - 1, 40).x, 0);
  EXPECT_EQ(disc.rgb(40 + int(radius) + 2, 40).x, 0);
}

// The integral of the point spread function over the hemisphere is 1, which its constants imply.
TEST(Develop, SpencersConstantsAreNormalised) {
  double total = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {  // angles from 1e-5 to 90 degrees by equal ratios
    const double step = std::log(9e6) / kSteps, angle = 1e-5 * std::exp((i + 0.5) * step);
    total +=
        spencerSpread(angle) * 2 * kPiD * std::sin(angle * kPiD / 180) * angle * kPiD / 180 * step;
  }
  EXPECT_NEAR(total, 1, 0.01);
}

TEST(Develop, GlareIsAMixtureOfGaussians) {
  for (const double pixelsPerDegree : {20.0, 100.0}) {
    const auto mixture = spencerGlare(pixelsPerDegree);
    double total = 0;
    for (const auto& gaussian : mixture) {
      total += gaussian.weight;
      EXPECT_GE(gaussian.weight, 0);
    }
    EXPECT_NEAR(total, 1, 1e-12);
    for (double angle = 0.1; angle < 8; angle *= 1.3) {
      double spread = 0;  // per steradian
      for (const auto& [weight, sigma] : mixture) {
        const double degrees = sigma / pixelsPerDegree, radians = degrees * kPiD / 180;
        if (sigma > 0)
          spread += weight / (2 * kPiD * radians * radians) *
                    std::exp(-0.5 * std::pow(angle / degrees, 2));
      }
      EXPECT_NEAR(spread / spencerSpread(angle), 1, 0.02) << angle << " " << pixelsPerDegree;
    }
  }
}

// A file may state a field of view of almost 0: no blur is wider than the widest.
TEST(Develop, GlareOfATinyFieldOfViewIsBounded) {
  for (const double pixelsPerDegree : {1e5, 1e9, 1e300, std::numeric_limits<double>::infinity()}) {
    const auto mixture = spencerGlare(pixelsPerDegree);
    EXPECT_LT(mixture.size(), 100u);
    for (const auto& [weight, sigma] : mixture) EXPECT_LE(sigma, kMaxSigma * (1 + 1e-9));
  }
}

TEST(Develop, InvalidPixelsAreCountedAndDoNotSpread) {
  Image image = filled(40, 30, 1);
  image.at(3, 4)[1] = std::numeric_limits<float>::quiet_NaN();
  image.at(30, 20)[0] = std::numeric_limits<float>::infinity();
  image.at(30, 20)[2] = -std::numeric_limits<float>::infinity();
  const Image depth = depthOf(40, 30, 1, 9);
  const DevelopSettings settings{.lens = ThinLens{2, 0.1},
                                 .motion = Motion{5, 20},
                                 .bloom = {{0.8, 1}, {0.2, 20}},
                                 .glare = true,
                                 .vignette = 0.5};
  EXPECT_EQ(develop(image, settings, &depth, {0, 0, 40, 30, 50}).invalid, 2u);
  for (const float texel : image.texels) EXPECT_TRUE(texel > 0 && texel < 1.001f) << texel;
}

TEST(Develop, AllMagnitudes) {
  for (const float radiance : {1e-8f, 1.0f, 1e10f, 3e38f}) {
    Image image = filled(50, 40, radiance);
    const DevelopSettings settings{
        .motion = Motion{9, 70}, .bloom = {{0.5, 2}, {0.5, 30}}, .vignette = 0.0};
    develop(image, settings, nullptr, {});
    EXPECT_LT(largestDifference(image, filled(50, 40, radiance)), 2e-6 * double(radiance));
  }
}

TEST(Develop, SameBitsForAnyNumberOfThreads) {
  Image image(257, 129, 3);
  for (size_t i = 0; i < image.texels.size(); ++i)
    image.texels[i] = 1.0f / float(1 + (i * 7919) % 1009);
  const Image depth = depthOf(257, 129, 1, 9);
  const DevelopSettings settings{.lens = ThinLens{2, 0.05},
                                 .motion = Motion{12, 30},
                                 .bloom = {{0.8, 1}, {0.2, 20}},
                                 .glare = true,
                                 .vignette = 0.5};
  Image all = image, one = image;
  develop(all, settings, &depth, {0, 0, 257, 129, 50});
  const ThreadLimit single(1);
  develop(one, settings, &depth, {0, 0, 257, 129, 50});
  EXPECT_EQ(all.texels, one.texels);
}

}  // namespace
}  // namespace chromeball::develop_test
