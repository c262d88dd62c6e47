// SPDX-License-Identifier: Apache-2.0
// The outline of a ball in a photograph.
#include "probe/capture/find_circle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "capture_photographs.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"
#include "paths.h"
#include "probe/capture/assemble.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::find_circle_test {
namespace {

void expectCircle(const Image& image, const Circle& truth, double tolerance, const char* what) {
  const std::optional<FoundCircle> found = findCircle(image);
  ASSERT_TRUE(found) << what;
  EXPECT_NEAR(found->circle.centre.x, truth.centre.x, tolerance) << what;
  EXPECT_NEAR(found->circle.centre.y, truth.centre.y, tolerance) << what;
  EXPECT_NEAR(found->circle.radius, truth.radius, tolerance) << what;
}

TEST(SlowFindCircle, OfABallUnderAProbe) {
  const Image dusk = loadProbe(kSourceDir + std::string("/probes/dusk.exr")).latLong;
  const Probe studio(studioProbe({512, 256})), evening(dusk);
  for (const Probe* probe : {&studio, &evening})
    for (const float background : {0.f, 0.2f, 5.f})
      for (const Circle& circle : {Circle{{150.3, 120.8}, 100.4}, Circle{{161, 119.5}, 60.2},
                                   Circle{{200, 130}, 128}}) {  // cropped
        const BallScene scene{*probe, kParallel, {}, BallReflectance(dvec3(0.6)), 3, background};
        expectCircle(photographOf(scene, 320, 240, circle), circle, 0.2,
                     fmt::format("background {}, radius {}", background, circle.radius).c_str());
      }
}

TEST(FindCircle, InALargePicture) {
  const Probe studio(studioProbe({512, 256}));
  const Circle circle{{1020.4, 770.6}, 512.3};
  const BallScene scene{studio, 32, {}, BallReflectance(dvec3(0.6)), 1, 0.3f};
  expectCircle(photographOf(scene, 2000, 1500, circle), circle, 0.2, "large");
}

// Programs that fill the pixels whose centres are inside have no pixel in between, and no noise.
TEST(FindCircle, OfADiscOfWholePixels) {
  for (const double radius : {31.71, 43.47, 48.71, 51.74, 54.37, 60.71, 73.65}) {
    const int side = int(2 * radius + 40);
    const Circle circle{{side / 2 + 1.3, side / 2 - 2.1}, radius};
    Image image(side, side, 3);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const double share = glm::distance(circle.centre, dvec2(x + 0.5, y + 0.5)) / radius;
        if (share < 1)
          image.setRgb(x, y,
                       Rgb(1, 0.8f, 0.6f) * float(0.3 + 0.5 * std::sqrt(1 - share * share) +
                                                  0.2 * std::sin(x / 7.0) * std::cos(y / 9.0)));
      }
    expectCircle(image, circle, 0.1, fmt::format("radius {}", radius).c_str());
  }
}

// A ball before a round table, whose outline is longer: the ball must be named.
TEST(FindCircle, NamesASecondCircle) {
  const Probe studio(studioProbe({512, 256}));
  const Circle ball{{160.3, 120.2}, 70}, table{{164.1, 123}, 88};
  Image image =
      photographOf({studio, kParallel, {}, BallReflectance(dvec3(0.6)), 1, 0}, 320, 240, ball);
  EXPECT_FALSE(findCircle(image).value().other);
  const auto covered = [](const Circle& circle, double x, double y) {
    return std::clamp(circle.radius - glm::distance(circle.centre, dvec2(x, y)) + 0.5, 0.0, 1.0);
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double share = covered(table, x + 0.5, y + 0.5) - covered(ball, x + 0.5, y + 0.5);
      image.setRgb(x, y, image.rgb(x, y) + Rgb(0.3f) * float(std::max(share, 0.0)));
    }
  const FoundCircle found = findCircle(image).value();
  ASSERT_TRUE(found.other) << found.circle.centre.x << ' ' << found.circle.radius << ' '
                           << found.support;
  const bool isBall = glm::distance(found.circle.centre, ball.centre) < 1;
  for (const auto& [seen, drawn] : {std::pair(found.circle, isBall ? ball : table),
                                    std::pair(*found.other, isBall ? table : ball)}) {
    EXPECT_LT(glm::distance(seen.centre, drawn.centre), 0.5);
    EXPECT_NEAR(seen.radius, drawn.radius, 0.5);
  }
}

// A ball in front of a pattern of stripes, with noise.
TEST(FindCircle, InFrontOfAPattern) {
  const Probe studio(studioProbe({512, 256}));
  const Circle circle{{170.3, 121.8}, 90.4};
  const BallScene scene{studio, kParallel, {}, BallReflectance(dvec3(0.6)), 3, 0};
  Image image = photographOf(scene, 320, 240, circle);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(1, 0.03f);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool isOutside = glm::distance(dvec2(x + 0.5, y + 0.5), circle.centre) > circle.radius;
      const float stripe = (x / 14 + y / 23) % 2 == 0 ? 0.5f : 2;
      const Rgb color = isOutside ? Rgb(stripe) : image.rgb(x, y);
      image.setRgb(x, y, color * std::max(noise(random), 0.f));
    }
  expectCircle(image, circle, 0.2, "pattern");
}

// The error of a found circle: the largest error of the centre's coordinates and the radius.
double errorOf(const Circle& found, const Circle& truth) {
  const dvec2 centre = glm::abs(found.centre - truth.centre);
  return std::max({centre.x, centre.y, std::fabs(found.radius - truth.radius)});
}

// The radiance behind a ball in a distant environment, which its rim continues.
dvec3 radianceInTheProbe(const BallScene& scene, const dvec2& p) {
  if (glm::length(p) < 1) return ballRadiance(scene, p);
  const CameraAxes axes(scene.camera);
  const double rim = 1 / std::sqrt(scene.distance * scene.distance - 1);
  const dvec3 ray = rim * (p.x * axes.right + p.y * axes.up) - axes.backwards;
  return dvec3(scene.probe.radiance(vec3(glm::normalize(ray))));
}

// Balls of constant reflectance and of chrome, in front of backgrounds that differ from their rims;
// and in front of the probe itself, which the rim of chrome continues.
TEST(SlowFindCircle, UnderRealProbes) {
  const Circle circle{{160.3, 158.8}, 139.2};
  for (const char* name : {"grace_probe.hdr", "galileo_probe.hdr", "beach_cross.hdr"}) {
    const auto path = sharedData(std::string("probes/debevec/") + name);
    if (!path) GTEST_SKIP() << "no shared data";
    const Image map =
        convert(loadProbe(*path).latLong, Mapping::LatLong, Mapping::LatLong, {512, 256});
    const Probe probe(map);
    const float mean = float(luminance(meanRadiance(map)));
    for (const BallReflectance& reflectance :
         {BallReflectance(dvec3(0.6)), BallReflectance::ofMetal(dvec3(0.55), {3.18, 3.31})}) {
      BallScene scene{probe, 12, {30, 0}, reflectance, 4, 0};
      for (const float background : {0.f, 1.f, 5.f}) {
        scene.background = background * mean;
        const auto found = findCircle(photographOf(scene, 320, 310, circle));
        ASSERT_TRUE(found) << name;
        const double error = errorOf(found->circle, circle);
        EXPECT_LT(error, background == 0 ? 0.15 : 0.1) << name;
        EXPECT_LT(error, 2 * found->standardError) << name;
        EXPECT_LT(found->standardError, background == 0 ? 0.2 : 0.1) << name;
      }
      const auto found = findCircle(photographOf(
          [&](const dvec2& p) { return radianceInTheProbe(scene, p); }, 320, 310, circle, 4));
      ASSERT_TRUE(found) << name;
      EXPECT_LT(errorOf(found->circle, circle), 0.25) << name;
      EXPECT_LT(errorOf(found->circle, circle), 2 * found->standardError) << name;
    }
  }
}

// A picture as a camera records it: the blur of its lens, noise, and as an HDR image or in 8 bits.
struct CameraModel {
  double blur = 0;  // standard deviation in pixels
  bool isHdr = true;
  uint32_t seed = 1;

  Image of(const Image& picture) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Image image = blurred(blurred(picture, {1, 0}), {0, 1});
    double mean = 0;
    for (const float texel : image.texels) mean += double(texel) / double(image.texels.size());
    for (float& texel : image.texels) {
      const double exposed = 0.25 * double(texel) / mean;
      const double noisy = exposed + std::hypot(0.001, 0.005 * std::sqrt(exposed)) * normal(random);
      texel = float(std::max(noisy, 0.0));
      if (isHdr) continue;
      texel = srgbToLinear(std::round(255 * linearToSrgb(std::min(texel, 1.f))) / 255);
    }
    return image;
  }

 private:
  Image blurred(const Image& image, const glm::ivec2& along) const {
    if (blur == 0) return image;
    const int reach = int(std::ceil(4 * blur));
    Image out(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        Rgb sum(0);
        float weights = 0;
        for (int i = -reach; i <= reach; ++i) {
          const float weight = float(std::exp(-0.5 * i * i / (blur * blur)));
          sum += weight * image.rgb(std::clamp(x + i * along.x, 0, image.width - 1),
                                    std::clamp(y + i * along.y, 0, image.height - 1));
          weights += weight;
        }
        out.setRgb(x, y, sum / weights);
      }
    return out;
  }
};

// Balls anywhere in pictures of many kinds: the stated error covers the true one.
TEST(SlowFindCircle, StatesItsDoubt) {
  std::vector<Probe> probes;
  std::vector<float> means;
  for (const char* name : {"debevec/grace_probe.hdr", "debevec/stpeters_cross.hdr",
                           "polyhaven/venice_sunset_1k.hdr", "polyhaven/pmndrs_lobby.hdr"}) {
    const auto path = sharedData(std::string("probes/") + name);
    if (!path) GTEST_SKIP() << "no shared data";
    const Image map = loadProbe(*path).latLong;
    probes.emplace_back(map);
    means.push_back(float(luminance(meanRadiance(map))));
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  const auto between = [&](double a, double b) { return a + (b - a) * uniform(random); };
  const BallReflectance reflectances[] = {BallReflectance(dvec3(0.6)),
                                          BallReflectance::schlick(dvec3(0.65)),
                                          BallReflectance::ofMetal(dvec3(0.55), {3.18, 3.31})};
  int found = 0, covered = 0;
  double sum = 0;
  constexpr int kBalls = 40;
  for (int i = 0; i < kBalls; ++i) {
    const size_t p = size_t(i) % probes.size();
    const double radius = i == 0 ? 400 : 40 * std::exp(between(0, std::log(4)));
    const int width = int(radius * between(2.4, 3.4)), height = int(radius * between(2.3, 3));
    const double x = between(1.06 * radius, width - 1.06 * radius);
    const double y = between(1.06 * radius, height - 1.06 * radius);
    const double distance = 6 * std::exp(between(0, std::log(10))), azimuth = between(0, 360);
    BallScene scene{probes[p], distance, {azimuth, 10}, reflectances[random() % 3], 6, 0};
    const double kind = uniform(random);
    scene.background = float(kind < 0.6 ? 0 : kind < 0.8 ? 0.3 : 4) * means[p];
    const auto radiance = [&](const dvec2& at) {
      return kind < 0.6 ? radianceInTheProbe(scene, at) : ballRadiance(scene, at);
    };
    const CameraModel camera{0.5 * int(random() % 3), random() % 2 == 0, uint32_t(i)};
    const Circle circle{{x, y}, radius};
    const auto result = findCircle(camera.of(photographOf(radiance, width, height, circle, 6)));
    if (!result) continue;
    ++found;
    const double error = errorOf(result->circle, circle);
    covered += error < 2 * result->standardError;
    sum += error;
    EXPECT_FALSE(error > 0.2 && result->standardError < 0.1) << i << ": " << error;
  }
  EXPECT_GE(found, 0.75 * kBalls);
  EXPECT_GE(covered, 0.9 * found);
  EXPECT_LT(sum / found, 0.3);
}

// The same without the exact circle: irradiance of the probe that is made with the found one.
TEST(SlowFindCircle, IsGoodEnoughForIrradiance) {
  const auto path = sharedData("probes/debevec/grace_probe.hdr");
  if (!path) GTEST_SKIP() << "no shared data";
  constexpr ImageSize kSize{256, 128};
  const Image map = convert(loadProbe(*path).latLong, Mapping::LatLong, Mapping::LatLong, kSize);
  const Probe probe(map);
  const Circle circle{{160.3, 158.8}, 139.2};
  std::vector<Image> photographs;
  std::vector<CaptureView> exact, found;
  photographs.reserve(2);
  const Image noMask;
  const auto optics = std::make_shared<BallOptics>(12, BallReflectance(dvec3(0.6)), 15);
  for (const double azimuth : {0.0, 90.0}) {
    const CameraPosition camera{azimuth, 0};
    photographs.push_back(photographOf(
        BallScene{probe, 12, camera, BallReflectance(dvec3(0.6)), 4, 0.3f}, 320, 310, circle));
    const Image& image = photographs.back();
    exact.emplace_back(image, noMask, circle, optics, camera);
    found.emplace_back(image, noMask, findCircle(image)->circle, optics, camera);
  }
  const IrradianceError best = irradianceError(assemble(exact, kSize).latLong, map);
  const IrradianceError automatic = irradianceError(assemble(found, kSize).latLong, map);
  EXPECT_LT(automatic.mean, 0.01);
  EXPECT_LT(automatic.largest, best.largest + 0.02);
}

// Parts of real panoramas: lamps, windows and arches, but no ball.
TEST(SlowFindCircle, FindsNoneInPlaces) {
  const auto path = sharedData("probes/polyhaven/pmndrs_lobby.hdr");
  if (!path) GTEST_SKIP() << "no shared data";
  const Image place = readImage(*path);
  std::mt19937 random(3);
  for (int i = 0; i < 3; ++i) {
    const int left = int(random() % uint32_t(place.width - 320));
    const int top = int(random() % uint32_t(place.height - 240));
    Image part(320, 240, 3);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x) part.setRgb(x, y, place.rgb(left + x, top + y));
    EXPECT_FALSE(findCircle(part)) << left << " " << top;
  }
}

TEST(FindCircle, FindsNoneWhereThereIsNone) {
  EXPECT_FALSE(findCircle(constantProbe({300, 200}, Rgb(1))));
  EXPECT_FALSE(findCircle(constantProbe({300, 200}, Rgb(0))));
  EXPECT_FALSE(findCircle(constantProbe({3, 2}, Rgb(1))));
  EXPECT_FALSE(findCircle(constantProbe({5000, 1}, Rgb(1))));
  Image noise(300, 200, 3), boxes(300, 200, 3), ramp(300, 200, 3);
  std::mt19937 random(3);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x) {
      noise.setRgb(x, y, Rgb(float(random() % 1000) / 1000));
      boxes.setRgb(x, y, Rgb(x > 60 && x < 240 && y > 30 && y < 170 ? 1.f : 0.1f));
      ramp.setRgb(x, y, Rgb(0.01f * float(x) + 0.1f));
    }
  EXPECT_FALSE(findCircle(noise));
  EXPECT_FALSE(findCircle(boxes));
  EXPECT_FALSE(findCircle(ramp));
}

// Hexagons, octagons and dodecagons, which are circles to 7, 4 and 2% of their radius.
TEST(SlowFindCircle, RegularPolygonsAreNoBalls) {
  constexpr int kFine = 4;
  for (const int corners : {6, 8, 12})
    for (const double radius : {75.0, 100.0, corners == 12 ? 200.0 : 75.0}) {
      const int width = std::max(320, int(2.6 * radius));
      const int height = std::max(240, int(2.4 * radius));
      const auto isInside = [&](const dvec2& p) {
        for (int i = 0; i < corners; ++i) {
          const double angle = 2 * kPiD * (i + 0.3) / corners;
          if (glm::dot(p, dvec2(std::cos(angle), std::sin(angle))) >
              radius * std::cos(kPiD / corners))
            return false;
        }
        return true;
      };
      Image image(width, height, 3);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          float sum = 0;
          for (int i = 0; i < kFine * kFine; ++i) {
            const dvec2 p(x - 0.5 * width - 0.3 + (i % kFine + 0.5) / kFine,
                          y - 0.5 * height + 0.4 + (i / kFine + 0.5) / kFine);
            sum += isInside(p) ? 0.3f + 0.2f * float(std::sin(p.x / 9) * std::sin(p.y / 7)) : 0.8f;
          }
          image.setRgb(x, y, Rgb(sum / (kFine * kFine)));
        }
      EXPECT_FALSE(findCircle(image)) << corners << " " << radius;
    }
}

// A ball in an office. The author of these photographs took the circle inscribed in the picture.
TEST(FindCircle, OfARealPhotograph) {
  const auto path =
      sharedData("reference/differential_rendering/bbold72_cs445_samples/calib_hdr.hdr");
  if (!path) GTEST_SKIP() << "no shared data";
  expectCircle(readImage(*path), {{190.5, 190.5}, 190.5}, 3, "office");
}

// Smooth pictures have contours that are circles almost.
TEST(SlowFindCircle, ContoursAreNoBalls) {
  constexpr int kWidth = 320, kHeight = 240;
  const auto picture = [](const auto& radiance) {
    Image image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        image.setRgb(x, y, Rgb(float(radiance(x - 160.5, y - 120.5))));
    return image;
  };
  for (const double width : {30.0, 50.0}) {
    EXPECT_FALSE(findCircle(picture([&](double x, double y) {
      return 0.02 + std::exp(-(x * x + y * y) / (2 * width * width));
    }))) << width;
  }
  EXPECT_FALSE(findCircle(picture([](double x, double y) {
    return 1 + 0.3 * std::sin(x / 17) * std::cos(y / 23) + 0.2 * std::sin((x + y) / 31);
  })));
}

}  // namespace
}  // namespace chromeball::find_circle_test
