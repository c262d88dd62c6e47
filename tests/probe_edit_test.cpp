// SPDX-License-Identifier: Apache-2.0
// Edits of a probe; the light lost by clipping, and whether a probe has been clipped.
#include "base/json.h"
#include "json_file.h"
#include "probe/edit.h"

#include <gtest/gtest.h>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "math/icosphere.h"
#include "probe/convert.h"
#include "probe/info.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"
#include "test_probes.h"

namespace chromeball::probe_edit_test {
namespace {

using nlohmann::json;

double irradianceOn(const Image& probe, const vec3& normal) {
  return exactIrradiance(probe, std::span(&normal, 1)).front().y;
}

TEST(ProbeEdit, WithoutItsLowerHalfAConstantProbeLightsAWallByHalf) {
  for (const int height : {32, 33, 1}) {
    Image probe = constantProbe({2 * height, height}, Rgb(1));
    const double wall = irradianceOn(probe, {0, 0, 1}), up = irradianceOn(probe, {0, 1, 0});
    replaceBelowHorizon(probe, Rgb(0));
    EXPECT_NEAR(irradianceOn(probe, {0, 0, 1}), wall / 2, 1e-6);
    if (height % 2 == 0) {
      EXPECT_EQ(irradianceOn(probe, {0, -1, 0}), 0);
      EXPECT_NEAR(irradianceOn(probe, {0, 1, 0}), up, 1e-9);
    }
    replaceBelowHorizon(probe, Rgb(1));
    EXPECT_EQ(probe.rgb(0, height - 1), Rgb(height == 1 ? 0.75f : 1));
  }
}

TEST(ProbeEdit, AMirroredSkyLightsFromBelowAsFromAbove) {
  for (const int height : {16, 17}) {
    Image probe = gradientProbe({2 * height, height}, Rgb(1), {0.3, 0.5, 0.2});
    const Image before = probe;
    mirrorAtHorizon(probe);
    for (const vec3& n : icosphereNormals(0))
      EXPECT_NEAR(irradianceOn(probe, n), irradianceOn(probe, {n.x, -n.y, n.z}), 1e-5);
    for (int y = 0; 2 * y < height; ++y) EXPECT_EQ(probe.rgb(3, y), before.rgb(3, y));
  }
}

// A disc of 20 degrees has a solid angle of 2 pi (1 - cos 20).
TEST(ProbeEdit, AGainKeepsTheBitsOfTheRest) {
  const Image before = gradientProbe({256, 128}, Rgb(1, 2, 3), {0.3, 0.5, 0.2});
  Image probe = before;
  const dvec3 centre = directionAt(170, -30);  // across the seam
  const size_t count = multiplyRegion(probe, centre, 20, Rgb(3, 1, 0));
  size_t changed = 0;
  double solidAngle = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 256; ++x) {
      const Rgb old = before.rgb(x, y);
      if (glm::dot(texelDirection({256, 128}, x, y), centre) < std::cos(kPiD / 9)) {
        EXPECT_EQ(probe.rgb(x, y), old);
        continue;
      }
      EXPECT_EQ(probe.rgb(x, y), old * Rgb(3, 1, 0));
      ++changed;
      solidAngle += texelSolidAngle(y, 256, 128);
    }
  EXPECT_EQ(count, changed);
  EXPECT_NEAR(solidAngle / (2 * kPiD * (1 - std::cos(kPiD / 9))), 1, 0.01);
  EXPECT_EQ(multiplyRegion(probe, directionAt(0, 90), 0.1, Rgb(1)), 0u);
}

// The convention: counter-clockwise seen from above, from -Z.
TEST(ProbeEdit, AzimuthIsCounterClockwise) {
  EXPECT_LT(glm::distance(directionAt(0, 0), dvec3(0, 0, -1)), 1e-15);
  EXPECT_LT(glm::distance(directionAt(90, 0), dvec3(-1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(directionAt(33, 90), dvec3(0, 1, 0)), 1e-15);
}

// In the plane of the stereographic projection, 2 + x + x^2 - y^2 is harmonic.
TEST(ProbeEdit, TheNadirIsFilledWithTheHarmonicContinuation) {
  const Image smooth = rasterize(Mapping::LatLong, {128, 64}, 1, [](const dvec3& d) {
    const double x = d.x / (1 - d.y), y = d.z / (1 - d.y);
    return d.y < 0 ? dvec3(2 + x + x * x - y * y, 1, x) + dvec3(0, 0, 1) : dvec3(1);
  });
  Image probe = smooth;
  multiplyRegion(probe, {0, -1, 0}, 30, Rgb(100));
  const int rows = fillNadir(probe, 30.5);
  EXPECT_EQ(rows, 11);  // of 2.8 degrees
  for (size_t i = 0; i < probe.texels.size(); ++i)
    EXPECT_NEAR(probe.texels[i], smooth.texels[i], 1e-5);
}

TEST(ProbeEdit, TheFilledNadirStaysWithinTheRangeOfItsRim) {
  Image probe = constantProbe({64, 32}, Rgb(1));
  probe.setRgb(20, 24, Rgb(1e10f, 1e-8f, 2));  // on the rim
  fillNadir(probe, 40);
  for (int y = 25; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_GE(probe.rgb(x, y).x, 1);
      EXPECT_LE(probe.rgb(x, y).y, 1);
      EXPECT_GE(probe.rgb(x, y).y, 1e-8f);
    }
  EXPECT_GT(probe.rgb(20, 25).x, 10 * probe.rgb(52, 25).x);
  for (const ImageSize& size : {ImageSize{1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 7}}) {
    Image tiny = constantProbe(size, Rgb(0.3f));
    fillNadir(tiny, 90);
    for (const float channel : tiny.texels) EXPECT_FLOAT_EQ(channel, 0.3f);
  }
}

// The light that clipping takes from the probe, as irradiance: the mean over many normals.
TEST(Clipping, LostLightIsLostIrradiance) {
  const Image probe = clearSkyProbe({128, 64}, {.sunElevation = 40});
  Image clipped = probe;
  clip(clipped, float(luminance(meanRadiance(probe)) / 0.18));
  const std::vector<vec3> normals = icosphereNormals(3);
  const std::vector<dvec3> before = exactIrradiance(probe, normals);
  const std::vector<dvec3> after = exactIrradiance(clipped, normals);
  dvec3 all(0), kept(0);
  for (size_t i = 0; i < normals.size(); ++i) all += before[i], kept += after[i];
  const double lost = lostIfClippedAtWhite(probe);
  EXPECT_GT(lost, 0.4);
  EXPECT_NEAR(1 - glm::dot(kept, dvec3(1)) / glm::dot(all, dvec3(1)), lost, 1e-3);
}

TEST(Clipping, OfSyntheticProbes) {
  EXPECT_EQ(lostIfClippedAtWhite(constantProbe({8, 4}, Rgb(1e10f))), 0);
  EXPECT_EQ(lostIfClippedAtWhite(constantProbe({8, 4}, Rgb(0))), 0);
  // All light in a texel of solid angle w: 4 pi/w times the mean; 1/0.18 of the mean is left.
  const double share = texelSolidAngle(5, 64, 32) / (4 * kPiD);
  for (const float radiance : {1e-8f, 1e10f})
    EXPECT_NEAR(lostIfClippedAtWhite(spot(64, 32, 9, 5, radiance, 0)), 1 - share / 0.18, 1e-6);

  EXPECT_NEAR(robustRange(constantProbe({8, 4}, Rgb(1e-8f))), 1, 1e-12);
  EXPECT_EQ(robustRange(constantProbe({8, 4}, Rgb(0))), 0);
  EXPECT_EQ(robustRange(spot(64, 32, 9, 16, 1, 0)), 0);  // lit in 0.08% of the sphere
  EXPECT_EQ(robustRange(overcastProbe({64, 32}, Rgb(1), 0)), INFINITY);
  EXPECT_NEAR(robustRange(spot(1024, 512, 9, 100, 1e10f, 1)), 1, 1e-12);  // the sun is left out
  // Over 1 + y the luminance y is uniformly distributed: 0.02 and 1.98 are exceeded by 99% and 1%.
  EXPECT_NEAR(robustRange(gradientProbe({512, 256}, Rgb(1), {0, 1, 0})), 99, 3);
}

// A smooth maximum, a sun and a constant map are not clipped; a sun that is cut at 16 times the
// mean is.
TEST(Clipping, PlateausOfSyntheticProbes) {
  const ImageSize size{512, 256};
  Image sky = clearSkyProbe(size, {.sunElevation = 40});
  for (const Image& probe :
       {constantProbe(size, Rgb(1)), constantProbe(size, Rgb(0)), constantProbe({1, 1}, Rgb(1)),
        overcastProbe(size, Rgb(1), 0.2), gradientProbe(size, Rgb(1), {0.3, 0.5, 0.2}), sky})
    EXPECT_FALSE(plateau(probe).looksClipped);
  EXPECT_EQ(plateau(constantProbe(size, Rgb(1))).texels, 512u * 256);
  EXPECT_NEAR(plateau(constantProbe(size, Rgb(1))).solidAngle, 4 * kPiD, 1e-9);
  clip(sky, float(16 * luminance(meanRadiance(sky))));
  for (int y = 60; y < 80; ++y)  // the haze around a photographed sun
    for (int x = 250; x < 270; ++x) sky.setRgb(x, y, Rgb(1e6f));
  clip(sky, float(luminance(meanRadiance(sky))));
  EXPECT_TRUE(plateau(sky).looksClipped);
}

TEST(SlowClipping, RealProbes) {
  // Irradiance lost, counted by an independent program on maps of 256 x 128.
  int found = 0;
  for (const auto& [file, expected] : {std::pair{"debevec/galileo_probe.hdr", 0.49},
                                       {"debevec/grace_probe.hdr", 0.59},
                                       {"debevec/stpeters_cross.hdr", 0.46},
                                       {"probulator/uffizi_latlong_small.hdr", 0.38},
                                       {"polyhaven/qwantani_afternoon_puresky_1k.hdr", 0.77},
                                       {"debevec/beach_cross.hdr", 0.04}})
    if (const auto path = sharedData(std::string("probes/") + file)) {
      const Image probe = loadProbe(*path).latLong;
      EXPECT_NEAR(lostIfClippedAtWhite(probe), expected, 0.016) << file;
      EXPECT_FALSE(plateau(probe).looksClipped) << file;
      ++found;
    }
  if (const auto path = sharedData("probes/misc/luxcore_arch_LDRclipped.exr")) {
    const Plateau clipped = plateau(loadProbe(*path).latLong);
    EXPECT_EQ(clipped.texels, 66729u);
    EXPECT_TRUE(clipped.looksClipped);
    ++found;
  }
  if (found == 0) GTEST_SKIP() << "no real probes";
}

TEST(SlowCommandEdit, DoesAllInTheOrderOfTheHelp) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "b.exr";
  Image image = gradientProbe({64, 32}, Rgb(1), {0.3, 0.5, 0.2});
  writeImage(in, image);
  const CommandResult result = runCommand({"probe",
                                           "edit",
                                           in,
                                           out,
                                           "--clip-stops",
                                           "1",
                                           "--scale",
                                           "2,2,4",
                                           "--below-horizon",
                                           "0.5,0.5,0.1",
                                           "--region",
                                           "-40,-20,30",
                                           "--region",
                                           "0,60,10",
                                           "--gain",
                                           "10",
                                           "--gain",
                                           "0",
                                           "--fill-nadir",
                                           "20"});
  EXPECT_EQ(result.status, 0) << result.error;
  fillNadir(image, 20);
  replaceBelowHorizon(image, Rgb(0.5, 0.5, 0.1));
  multiplyRegion(image, directionAt(-40, -20), 30, Rgb(10));
  multiplyRegion(image, directionAt(0, 60), 10, Rgb(0));
  multiply(image, Rgb(2, 2, 4));
  clip(image, float(2 * luminance(meanRadiance(image))));
  EXPECT_EQ(readImage(out).texels, image.texels);
}

TEST(SlowCommandEdit, InfoSeesThatAProbeIsClipped) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "b.exr";
  writeImage(in, gradientProbe({64, 32}, Rgb(1), {0.3, 0.5, 0.2}));
  const auto infoOf = [](const std::string& file) {
    return parseJson(runCommand({"probe", "info", file, "--json"}).out);
  };
  EXPECT_EQ(infoOf(in)["plateau"]["looks_clipped"], false);
  EXPECT_NEAR(infoOf(in)["max_over_mean"].get<double>(), 1 + std::sqrt(0.38), 0.01);
  EXPECT_EQ(runCommand({"probe", "edit", in, out, "--clip", "1.25"}).status, 0);
  const json clipped = infoOf(out);
  EXPECT_NEAR(clipped["robust_range"].get<double>(), 1.25 / (1 - 0.98 * std::sqrt(0.38)), 0.1);
  EXPECT_EQ(clipped["max"], json({1.25, 1.25, 1.25}));
  EXPECT_EQ(clipped["plateau"]["looks_clipped"], true);
  // Radiance is distributed uniformly from 1 - s to 1 + s, s = |slope|.
  EXPECT_NEAR(clipped["plateau"]["solid_angle"].get<double>() / (4 * kPiD),
              0.5 - 0.25 / 2 / std::sqrt(0.38), 0.01);
  EXPECT_NE(runCommand({"probe", "info", out}).out.find("looks clipped"), std::string::npos);
}

TEST(SlowCommandEdit, WarnsOfWhatAPngClips) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr";
  writeImage(in, spot(10, 5, 3, 1, 2, 0.5f));
  const auto errorsOf = [&](const std::string& out, const std::string& clip) {
    return runCommand({"probe", "edit", in, folder / out, "--clip", clip}).error;
  };
  EXPECT_NE(errorsOf("b.png", "1.5").find("2% of the channels are above 1"), std::string::npos);
  EXPECT_EQ(errorsOf("b.png", "1"), "");
  EXPECT_EQ(errorsOf("b.exr", "1.5"), "");
}

// Nothing lit, hardly anything, and half of the sphere.
TEST(SlowCommandEdit, InfoSaysWhyThereIsNoRobustRange) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.exr";
  const auto rangeOf = [&](const Image& image, const std::string& text) {
    writeImage(file, image);
    EXPECT_NE(runCommand({"probe", "info", file}).out.find(text), std::string::npos) << text;
    return parseJson(runCommand({"probe", "info", file, "--json"}).out)["robust_range"];
  };
  EXPECT_EQ(rangeOf(spot(64, 32, 9, 16, 1, 0), "none: less than 1% of the sphere is lit"), 0);
  EXPECT_TRUE(rangeOf(overcastProbe({64, 32}, Rgb(1), 0), "infinite: more than 1%").is_null());
}

TEST(SlowCommandEdit, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "b.exr";
  writeImage(in, spot(8, 4, 3, 1, 1e30f, 1e-8f));
  const auto expect = [&](std::vector<std::string> options, const std::string& reason) {
    std::vector<std::string> arguments{"probe", "edit", in, out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectError(arguments, reason);
  };
  expect({}, "nothing to do");
  expect({"--below-horizon", "blck"}, "black, mirror");
  expect({"--below-horizon", "1,2"}, "--below-horizon");
  expect({"--below-horizon", "1,2,-3"}, "not negative");
  expect({"--clip", "0"}, "--clip: 0 should be above 0");
  expect({"--clip", "nan"}, "--clip");
  expect({"--clip", "1", "--clip-stops", "2"}, "--clip");
  expect({"--clip-stops", "many"}, "--clip-stops");
  expect({"--scale", "1e300"}, "--probe-scale");
  expect({"--scale", "1e39"},
         "--probe-scale: 1e39 should be not negative: 0, or 1.4e-45 to 3.4e38");
  expect({"--scale", "1,1,1e-46"}, "1.4e-45 to 3.4e38");
  expect({"--scale", "1,2"}, "--probe-scale: `1,2` should be one number, or three");
  expect({"--clip", "1e-46"}, "--clip: 1e-46 should be above 0: 1.4e-45 to 3.4e38");
  expect({"--clip-stops", "-300"}, "--clip-stops: ");
  expect({"--region", "1e300,0,30", "--gain", "2"}, "--region: the azimuth 1e+300");
  expect({"--scale", "1e30"}, "exceeds the range of a float");
  expect({"--scale", "1,2,3,4"}, "--probe-scale");
  expect({"--region", "0,0,30"}, "--gain");
  expect({"--gain", "2"}, "--region");
  expect({"--region", "0,91,30", "--gain", "2"}, "elevation");
  expect({"--region", "0,0,0", "--gain", "2"}, "radius");
  expect({"--region", "0,0", "--gain", "2"}, "--region");
  expect({"--region", "0,0,1", "--gain", "2"}, "no texel's centre");
  expect({"--fill-nadir", "91"}, "up to 90");
  expect({"--fill-nadir", "5"}, "no texel's centre");
  expectError({"probe", "edit", in, in, "--clip", "1"}, "would overwrite");
  expectError({"probe", "edit", folder / "none.exr", out, "--clip", "1"}, "no such file");
  EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

}  // namespace
}  // namespace chromeball::probe_edit_test
