// SPDX-License-Identifier: Apache-2.0
// The outline of a ball in a photograph.
#include "probe/capture/find_circle.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "capture_photographs.h"
#include "image/io/read_image.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball {
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
        expectCircle(photographOf(scene, 320, 240, circle), circle, 0.75,
                     fmt::format("background {}, radius {}", background, circle.radius).c_str());
      }
}

TEST(FindCircle, InALargePicture) {
  const Probe studio(studioProbe({512, 256}));
  const Circle circle{{1020.4, 770.6}, 512.3};
  const BallScene scene{studio, 32, {}, BallReflectance(dvec3(0.6)), 1, 0.3f};
  expectCircle(photographOf(scene, 2000, 1500, circle), circle, 0.5, "large");
}

// In front of a pattern of stripes, with noise.
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
  expectCircle(image, circle, 0.7, "pattern");
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

// A ball in an office. The author of these photographs took the circle inscribed in the picture.
TEST(FindCircle, OfARealPhotograph) {
  const auto path =
      sharedData("reference/differential_rendering/bbold72_cs445_samples/calib_hdr.hdr");
  if (!path) GTEST_SKIP() << "no shared data";
  expectCircle(readImage(*path), {{190.5, 190.5}, 190.5}, 3, "office");
}

}  // namespace
}  // namespace chromeball
