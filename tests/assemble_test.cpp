// SPDX-License-Identifier: Apache-2.0
// Probes from photographs of a mirror ball: closed loops with photographs of a known probe.
#include "probe/capture/assemble.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "capture_photographs.h"
#include "paths.h"
#include "probe/capture/match_views.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::assemble_test {
namespace {

constexpr ImageSize kSize{256, 128};
constexpr int kPixels = 320;
const Circle kCircle{{158.3, 161.9}, 151.2};
const dvec3 kChrome(0.632, 0.647, 0.653);

std::shared_ptr<const CaptureOptics> ball(double distance, const BallReflectance& reflectance) {
  return std::make_shared<BallOptics>(distance, reflectance, 15);
}

// The mean radiance is 1, so that every probe has the same brightness around the ball.
Image normalised(Image map) {
  const double mean = luminance(meanRadiance(map));
  for (float& channel : map.texels) channel = float(channel / mean);
  return convert(map, Mapping::LatLong, Mapping::LatLong, kSize);
}

std::vector<std::pair<std::string, Image>> probes() {
  std::vector<std::pair<std::string, Image>> all;
  all.emplace_back("studio", normalised(studioProbe({512, 256})));
  all.emplace_back("dusk",
                   normalised(loadProbe(kSourceDir + std::string("/probes/dusk.exr")).latLong));
  if (const auto galileo = sharedData("probes/debevec/galileo_probe.hdr"))
    all.emplace_back("galileo", normalised(loadProbe(*galileo).latLong));
  return all;
}

const Image kNoMask;

// A loop of photographs from these azimuths.
struct Loop {
  std::vector<Image> photographs;
  std::vector<CaptureView> views;

  Loop(const Probe& probe, double distance, const BallReflectance& reflectance,
       const std::vector<CameraPosition>& cameras) {
    photographs.reserve(cameras.size());
    for (const CameraPosition& camera : cameras) {
      const BallScene scene{probe, distance, camera, reflectance};
      photographs.push_back(photographOf(scene, kPixels, kPixels, kCircle));
      views.emplace_back(photographs.back(), kNoMask, kCircle, ball(distance, reflectance), camera);
    }
  }
};

TEST(SlowAssemble, TwoViewsReturnTheProbe) {
  for (const auto& [name, map] : probes())
    for (const double distance : {kParallel, 32.0}) {
      const Probe probe(map);
      const BallReflectance chrome = BallReflectance::ofMetal(kChrome, {3.18, 3.31});
      Loop two(probe, distance, chrome, {{0, 0}, {90, 0}});
      const std::vector<ViewMatch> matches = matchViews(two.views, true, true);
      EXPECT_NEAR(matches[1].turn, 0, 0.05) << name;
      EXPECT_NEAR(matches[1].gain, 1, 0.003) << name;
      Assembly assembly = assemble(two.views, kSize);
      EXPECT_EQ(assembly.blindShare, 0) << name;
      const IrradianceError error = irradianceError(assembly.latLong, map, 5);
      EXPECT_LT(error.mean, 0.005) << name << " " << distance;
      EXPECT_LT(error.largest, 0.02) << name << " " << distance;
      RecordProperty(name + "_mean", std::to_string(error.mean));
    }
}

// The error is in the blind cone, and around it, where few pixels of the rim show the probe.
TEST(SlowAssemble, OneViewIsWrongBehindTheBall) {
  const Image map = normalised(studioProbe({512, 256}));
  const Probe probe(map);
  Loop one(probe, 32, BallReflectance(kChrome), {{180, 0}});
  Loop two(probe, 32, BallReflectance(kChrome), {{180, 0}, {90, 0}});
  Assembly alone = assemble(one.views, kSize), both = assemble(two.views, kSize);
  // The share of a cap of radius asin(1 / 32), whose rim crosses texels of pi / height radians: to
  // within a quarter of a texel all around.
  const double rim = std::asin(1 / 32.), quarter = kPiD / kSize.height / 4;
  EXPECT_NEAR(alone.blindShare, 0.5 * (1 - std::cos(rim)), 0.5 * std::sin(rim) * quarter);
  EXPECT_EQ(both.blindShare, 0);
  inpaintBlind(alone);
  const auto errorBehind = [&](const Assembly& assembly) {  // of radiance, within 20 degrees
    double error = 0, truth = 0;
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 0; x < kSize.width; ++x) {
        if (texelDirection(kSize, x, y).z < std::cos(20 * kPiD / 180)) continue;
        const double solidAngle = texelSolidAngle(y, kSize.width, kSize.height);
        error +=
            solidAngle * std::fabs(luminance(dvec3(assembly.latLong.rgb(x, y) - map.rgb(x, y))));
        truth += solidAngle * luminance(dvec3(map.rgb(x, y)));
      }
    return error / truth;
  };
  EXPECT_GT(errorBehind(alone), 0.03);
  EXPECT_LT(errorBehind(both), 0.3 * errorBehind(alone));
}

// Views of a sharp room, with turns and exposures that differ from the given ones.
TEST(SlowAssemble, ViewsAreTurnedAndExposedToMatch) {
  const Image map = normalised(studioProbe({512, 256}));
  const Probe probe(map);
  for (const double turn : {-4.3, 0.8, 2.35}) {
    Loop loop(probe, kParallel, BallReflectance(), {{0, 0}, {90, 10}});
    for (float& channel : loop.photographs[1].texels) channel *= 1.7f;
    loop.views[1].setCamera({90 - turn, 10});
    const std::vector<ViewMatch> matches = matchViews(loop.views, true, true);
    EXPECT_NEAR(matches[1].turn, turn, 0.05);
    EXPECT_NEAR(matches[1].gain * 1.7, 1, 0.005);
    EXPECT_GT(matches[1].correlation, 0.95);
    EXPECT_LT(irradianceError(assemble(loop.views, kSize).latLong, map).mean, 0.006);
  }
}

TEST(SlowAssemble, NothingIsMatchedWithoutAReason) {
  const Probe even(constantProbe(kSize, Rgb(1)));
  Loop loop(even, kParallel, BallReflectance(), {{0, 0}, {90, 0}});
  const std::vector<ViewMatch> matches = matchViews(loop.views, true, true);
  EXPECT_FALSE(matches[1].turned);  // a constant has no orientation
  EXPECT_EQ(matches[1].turn, 0);
  EXPECT_NEAR(matches[1].gain, 1, 1e-6);
  const Probe studio(normalised(studioProbe({512, 256})));
  Loop kept(studio, kParallel, BallReflectance(), {{0, 0}, {90, 0}});
  for (float& channel : kept.photographs[1].texels) channel *= 3;
  kept.views[1].setCamera({92, 0});
  const ViewMatch match = matchViews(kept.views, false, false)[1];
  EXPECT_EQ(match.turn, 0);
  EXPECT_EQ(match.gain, 1);
  EXPECT_GT(match.overlap, 0.3);
}

// A view that shows only the half that a mask leaves, and the other view in its place.
TEST(Assemble, MasksAreBlindUnlessAnotherViewShows) {
  const Image map = gradientProbe(kSize, Rgb(1), {0.4, 0.3, -0.5});
  const Probe probe(map);
  const BallScene front{probe, kParallel, {0, 0}, BallReflectance(), 2};
  const BallScene side{probe, kParallel, {90, 0}, BallReflectance(), 2};
  const Image first = photographOf(front, kPixels, kPixels, kCircle),
              second = photographOf(side, kPixels, kPixels, kCircle);
  Image lower(kPixels, kPixels, 1);
  for (int y = 0; y < kPixels; ++y)
    for (int x = 0; x < kPixels; ++x) *lower.at(x, y) = y + 0.5 < kCircle.centre.y ? 1.f : 0.f;
  const std::vector<CaptureView> alone{
      {first, lower, kCircle, ball(kParallel, BallReflectance()), front.camera}};
  const Assembly half = assemble(alone, kSize);
  // The lower half of the ball shows what is below the horizon, and the rim half of it again.
  EXPECT_NEAR(half.blindShare, 0.5, 0.02);
  for (int x = 0; x < kSize.width; ++x) {
    EXPECT_EQ(*half.coverage.at(x, kSize.height - 10), 0);
    EXPECT_EQ(half.latLong.rgb(x, kSize.height - 10), Rgb(0));
  }
  const std::vector<CaptureView> two{
      alone[0], {second, kNoMask, kCircle, ball(kParallel, BallReflectance()), side.camera}};
  const Assembly both = assemble(two, kSize);
  EXPECT_LT(both.blindShare, 0.01);
  EXPECT_LT(irradianceError(both.latLong, map).mean, 0.005);
}

// A ball cropped by the picture.
TEST(Assemble, WhatIsOutsideThePictureIsBlind) {
  const Image map = constantProbe(kSize, Rgb(1));
  const Probe probe(map);
  const Circle high{{160, 140}, 151};
  const Image cropped =
      photographOf(BallScene{probe, kParallel, {}, BallReflectance(), 2}, kPixels, 280, high);
  const std::vector<CaptureView> views{
      {cropped, kNoMask, high, ball(kParallel, BallReflectance()), {}}};
  const Assembly assembly = assemble(views, kSize);
  EXPECT_NEAR(shareInside(high, kPixels, 280), 1 - assembly.blindShare, 0.015);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (*assembly.coverage.at(x, y) > 0) {
        ASSERT_NEAR(assembly.latLong.rgb(x, y).y, 1, 1e-5);
      }
}

TEST(SlowAssemble, IsTheSameForAnyNumberOfThreads) {
  const Image map = normalised(studioProbe({512, 256}));
  const Probe probe(map);
  const auto assembled = [&] {
    Loop loop(probe, 8, BallReflectance(kChrome), {{10, 5}, {100, 0}});
    matchViews(loop.views, true, true);
    Assembly assembly = assemble(loop.views, {64, 32});
    inpaintBlind(assembly);
    return assembly;
  };
  const Assembly many = assembled();
  const ThreadLimit one(1);
  const Assembly single = assembled();
  EXPECT_EQ(many.latLong.texels, single.latLong.texels);
  EXPECT_EQ(many.blindShare, single.blindShare);
}

// Two views through a lens of 180 degrees show all of a room (Madsen et al. 2003), one of 200 with
// some overlap.
TEST(SlowAssemble, TwoFisheyeViewsReturnTheProbe) {
  const Image map = normalised(studioProbe({512, 256}));
  const Probe probe(map);
  for (const Fisheye& lens :
       {Fisheye{180, FisheyeProjection::Equidistant}, Fisheye{180, FisheyeProjection::Equisolid},
        Fisheye{200, FisheyeProjection::Stereographic}}) {
    const auto optics = std::make_shared<FisheyeOptics>(lens);
    std::vector<Image> photographs;
    std::vector<CaptureView> views;
    photographs.reserve(2);
    for (const double azimuth : {30.0, 210.0}) {
      const CameraAxes axes({azimuth, 0});
      photographs.push_back(photographOf(
          [&](const dvec2& p) {
            const double radius = glm::length(p), angle = lens.angle(radius);
            if (radius > 1) return dvec3(0);
            const dvec2 side = radius > 0 ? p / radius * std::sin(angle) : dvec2(0);
            const dvec3 d =
                side.x * axes.right + side.y * axes.up - std::cos(angle) * axes.backwards;
            return dvec3(probe.radiance(vec3(d)));
          },
          kPixels, kPixels, kCircle, 3));
      views.emplace_back(photographs.back(), kNoMask, kCircle, optics, CameraPosition{azimuth, 0});
    }
    const Assembly assembly = assemble(views, kSize);
    EXPECT_LT(assembly.blindShare, 1e-9) << fisheyeName(lens);
    const IrradianceError error = irradianceError(assembly.latLong, map);
    EXPECT_LT(error.mean, 0.002) << fisheyeName(lens);
    EXPECT_LT(error.largest, 0.01) << fisheyeName(lens);
  }
}

}  // namespace
}  // namespace chromeball::assemble_test
