// SPDX-License-Identifier: Apache-2.0
// Synthetic probes: skies and suns, overcast, gradient, studio.
#include "probe/synth.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "probe/mapping.h"

namespace chromeball::sky_test {
namespace {

// Sum over texels of radiance x solid angle x max(0, cosine to `normal`).
dvec3 irradiance(const Image& image, const dvec3& normal) {
  const int w = image.width, h = image.height;
  dvec3 sum(0);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (isBlack(image.rgb(x, y))) continue;
      const dvec3 d = *uvToDirection(Mapping::LatLong, {(x + 0.5) / w, (y + 0.5) / h});
      sum += dvec3(image.rgb(x, y)) * texelSolidAngle(y, w, h) * std::max(0.0, glm::dot(d, normal));
    }
  return sum;
}

TEST(SlowSky, SunIrradianceIsIndependentOfResolution) {
  const dvec3 given(3, 2, 1);
  for (const double elevation : {0.0, 30.0, 89.9, 90.0}) {
    ClearSky sky;
    sky.sunElevation = elevation;
    sky.sunAzimuth = 179.9;  // the disc crosses the seam
    for (const int height : {1, 2, 8, 32, 100, 512, 2048}) {
      if (height == 2048 && elevation != 30) continue;
      Image image(2 * height, height, 3);
      addSunDisc(image, sunDirection(sky), kSunDiameter, given);
      const dvec3 found = irradiance(image, sunDirection(sky));
      if (height > 2) {
        EXPECT_LT(glm::distance(found, given), 1e-3 * 3) << height << " " << elevation;
      }
      EXPECT_TRUE(glm::length(found) > 0 && std::isfinite(found.x));
    }
  }
}

// The smallest discs have the most samples a texel; near a pole they reach every texel of a row.
// (Sampling all of these takes a minute.)
TEST(Sky, SmallSunsNearThePolesKeepTheirIrradiance) {
  constexpr int kSuns = 200;
  Image image(128, 64, 3);
  const dvec3 zenith(0, 1, 0);
  for (int i = 0; i < kSuns; ++i)
    addSunDisc(image, glm::normalize(zenith + 1e-5 * i * dvec3(0.6, 0, 0.8)), 0.01, dvec3(3, 2, 1));
  EXPECT_LT(glm::distance(irradiance(image, zenith) / double(kSuns), {3, 2, 1}), 1e-3 * 3);
}

// Discs over a pole, beside it and across the seam cover each texel by its share of them.
TEST(Sky, DiscsCoverTheirShareOfEachTexel) {
  const int w = 64, h = 32;
  for (const double elevation : {90.0, 89.0, -80.0, 5.0, 30.0})
    for (const double radius : {9.0, 20.0, 44.0}) {
      ClearSky sky;
      sky.sunElevation = elevation;
      sky.sunAzimuth = 178;
      const dvec3 towards = sunDirection(sky);
      Image image(w, h, 3);
      addSunDisc(image, towards, 2 * radius, dvec3(1));
      const double cosRadius = std::cos(radius * kPiD / 180);
      float brightest = 0;
      for (const float texel : image.texels) brightest = std::max(brightest, texel);
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          constexpr int kSide = 32;
          int inside = 0;
          for (int i = 0; i < kSide * kSide; ++i) {
            const dvec2 uv((x + (i % kSide + 0.5) / kSide) / w,
                           (y + (i / kSide + 0.5) / kSide) / h);
            inside += glm::dot(*uvToDirection(Mapping::LatLong, uv), towards) >= cosRadius;
          }
          ASSERT_NEAR(image.rgb(x, y).x / brightest, double(inside) / (kSide * kSide), 0.25)
              << elevation << " " << radius << ": " << x << " " << y;
        }
    }
}

TEST(SlowSky, SunHasTheGivenDiameterAndConstantRadiance) {
  ClearSky sky;
  Image image(8192, 4096, 3);
  addSunDisc(image, sunDirection(sky), kSunDiameter, dvec3(kPiD));
  double solidAngle = 0;
  float brightest = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float radiance = image.rgb(x, y).x;
      if (radiance > 0) solidAngle += texelSolidAngle(y, image.width, image.height);
      brightest = std::max(brightest, radiance);
    }
  // If a sun of 0.5323 degrees gives a white surface the radiance 1, its radiance is 46,700 to 1%.
  EXPECT_NEAR(brightest, 46700, 467);
  const double radius = kSunDiameter / 2 * kPiD / 180;
  // Texels at the rim count as covered: the radius is up to half a texel (0.044 degrees) larger.
  EXPECT_NEAR(std::sqrt(solidAngle / kPiD) / radius, 1, 0.15);
}

TEST(Sky, SunHasTheGivenDirection) {
  ClearSky sky;
  sky.sunElevation = 30;
  sky.sunAzimuth = 90;  // counter-clockwise seen from above: from -Z to -X
  EXPECT_LT(glm::distance(sunDirection(sky), dvec3(-std::sqrt(0.75), 0.5, 0)), 1e-12);
}

TEST(Sky, ClearSkyIsPlausible) {
  for (const double turbidity : {2.0, 3.0, 6.0, 10.0})
    for (const double elevation : {0.0, 5.0, 20.0, 45.0, 90.0}) {
      ClearSky sky;
      sky.turbidity = turbidity;
      sky.sunElevation = elevation;
      const Image image = clearSkyProbe({64, 32}, sky, false);
      for (const float f : image.texels) ASSERT_TRUE(std::isfinite(f) && f >= 0);
    }
  // A clear sky at noon is blue and gives level ground 10 to 40 klx (100 klx is an irradiance of
  // pi); the sun gives several times more, and is reddish when low.
  const ClearSky noon{.sunElevation = 60};
  const dvec3 sky = irradiance(clearSkyProbe({256, 128}, noon, false), dvec3(0, 1, 0));
  EXPECT_GT(luminance(Rgb(sky)), 0.1 * kPiD);
  EXPECT_LT(luminance(Rgb(sky)), 0.4 * kPiD);
  EXPECT_GT(sky.z, sky.x);
  EXPECT_GT(luminance(Rgb(sunIrradiance(noon))), 0.6 * kPiD);
  EXPECT_LT(luminance(Rgb(sunIrradiance(noon))), 1.28 * kPiD);
  const dvec3 evening = sunIrradiance({.sunElevation = 5});
  EXPECT_GT(evening.x, 2 * evening.z);
  // More haze attenuates the sun.
  EXPECT_LT(sunIrradiance({.turbidity = 6}).y, sunIrradiance({.turbidity = 3}).y);
}

TEST(Sky, GroundReflectsItsIrradiance) {
  const ClearSky sky{.sunElevation = 40, .groundAlbedo = 0.5};
  const Image image = clearSkyProbe({512, 256}, sky);
  const dvec3 received = irradiance(image, dvec3(0, 1, 0));
  const dvec3 ground = dvec3(image.rgb(100, 200));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(ground[c] / (0.5 / kPiD * received[c]), 1, 0.005);
}

TEST(Sky, OutOfRangeIsRejected) {
  EXPECT_THROW(clearSkyProbe({4, 2}, {.sunElevation = -1}), InputError);
  EXPECT_THROW(clearSkyProbe({4, 2}, {.turbidity = 1}), InputError);
  EXPECT_THROW(clearSkyProbe({4, 2}, {.turbidity = std::nan("")}), InputError);
}

TEST(Synth, OvercastIrradianceIsSevenNinthsOfPi) {
  const Image image = overcastProbe({256, 128}, Rgb(2), 0.5);
  EXPECT_NEAR(irradiance(image, dvec3(0, 1, 0)).x, 2 * 7 * kPiD / 9, 2e-3);
  EXPECT_NEAR(irradiance(image, dvec3(0, -1, 0)).x, 0.5 * 2 * 7 * kPiD / 9, 2e-3);
  EXPECT_NEAR(image.rgb(0, 0).x, 2, 1e-3);
}

TEST(Synth, GradientIrradiance) {
  const dvec3 slope(0.2, 0.5, -0.4), normal = glm::normalize(dvec3(1, 2, 3));
  const Image image = gradientProbe({512, 256}, Rgb(1, 2, 3), slope);
  const dvec3 expected = kPiD * dvec3(1, 2, 3) * (1 + 2.0 / 3 * glm::dot(slope, normal));
  EXPECT_LT(glm::distance(irradiance(image, normal), expected), 1e-3);
  EXPECT_NEAR(meanRadiance(image).y, 2, 1e-4);
}

TEST(Synth, StudioHasLightsInADarkRoom) {
  const Image image = studioProbe({256, 128});
  float brightest = 0, darkest = 1;
  for (const float f : image.texels)
    brightest = std::max(brightest, f), darkest = std::min(darkest, f);
  EXPECT_FLOAT_EQ(brightest, 30);
  EXPECT_FLOAT_EQ(darkest, 0.02f);
  // The key light is on the right.
  EXPECT_GT(irradiance(image, dvec3(1, 0, 0)).x, 1.5 * irradiance(image, dvec3(-1, 0, 0)).x);
}

}  // namespace
}  // namespace chromeball::sky_test
