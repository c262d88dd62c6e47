// SPDX-License-Identifier: Apache-2.0
// Perspective crops of a probe: the directions of their pixels, and back through `probe stitch`.
#include "probe/convert.h"

#include <gtest/gtest.h>

#include <fstream>

#include <fmt/format.h>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::crop_test {
namespace {

using glm::dvec3;

void expectNear(const dvec3& a, const dvec3& b) { EXPECT_LT(glm::distance(a, b), 1e-6); }

PinholeView viewOf(const Rotation::Angles& angles) {
  return {Rotation::ofAngles(angles), 60, {40, 20}};
}

TEST(Crop, PixelsShowTheirDirections) {
  constexpr double kTangent = 0.5773502691896258;  // of half the field of view, 30 degrees
  expectNear(viewOf({0, 0, 0}).direction(20, 10), {0, 0, -1});
  expectNear(viewOf({90, 0, 0}).direction(20, 10), {-1, 0, 0});
  expectNear(viewOf({0, 90, 0}).direction(20, 10), {0, 1, 0});
  expectNear(viewOf({0, 0, 0}).direction(20, 0), {0, 0.5, -std::sqrt(0.75)});
  expectNear(viewOf({0, 0, 0}).direction(40, 10), glm::normalize(dvec3(2 * kTangent, 0, -1)));
  // A roll by a quarter lifts the camera's right to the top.
  expectNear(viewOf({0, 0, 90}).direction(40, 10), glm::normalize(dvec3(0, 2 * kTangent, -1)));
}

// Radiance 1 + slope . D: a pixel's is that of its direction, up to the map's interpolation and
// the mean over the pixel.
TEST(Crop, PixelsHaveTheRadianceOfTheirDirections) {
  const dvec3 slope(0.3, -0.5, 0.4);
  const Image map = gradientProbe({512, 256}, Rgb(1), slope);
  for (const Rotation::Angles& pose : {Rotation::Angles{0, 0, 0}, Rotation::Angles{130, 50, -25},
                                       Rotation::Angles{-60, -80, 10}}) {
    const PinholeView view = viewOf(pose);
    const Image image = crop(map, view);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        EXPECT_NEAR(image.rgb(x, y).y, 1 + glm::dot(slope, view.direction(x + 0.5, y + 0.5)), 1e-3);
  }
}

// Almost all of a plane that is nearly a hemisphere's lies at its border; a pixel takes no more
// samples than there are texels in it.
TEST(Crop, ViewsOfNearlyAHemisphere) {
  Image map(64, 32, 3);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x) map.setRgb(x, y, Rgb(1));
  const Image image = crop(map, PinholeView{{}, 179.9, {8, 8}});
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(image.rgb(x, y).x, y < 4 ? 1 : 0, 0.1) << y;
}

TEST(Crop, PixelsInTheMiddleAreAsWideAsTexels) {
  const Image map(512, 256, 3);
  const PinholeView view{{}, 50, {100, rowsOfCrop(map, 50)}};
  EXPECT_NEAR(view.pixelAngle() / (kPiD / 256), 1, 0.01);
}

// Six crops that overlap give the probe back.
TEST(CommandProbeCrop, StitchingGivesTheProbeBack) {
  const TemporaryFolder folder;
  const Image map = gradientProbe({128, 64}, Rgb(1, 2, 3), {0.3, -0.5, 0.4});
  writeImage(folder / "probe.exr", map);
  std::ofstream list(folder / "tiles.toml");
  list << "fov = 120\n";
  int count = 0;
  for (const auto& [yaw, pitch] :
       {std::pair{0, 0}, {90, 0}, {180, 0}, {-90, 0}, {30, 90}, {-20, -90}}) {
    const std::string name = fmt::format("{}.exr", count++), y = fmt::format("{}", yaw),
                      p = fmt::format("{}", pitch);
    const CommandResult result =
        runCommand({"probe", "crop", folder / "probe.exr", folder / name, "--fov", "120", "--yaw",
                    y, "--pitch", p, "--roll", "20", "--size", "96x96"});
    ASSERT_EQ(result.status, 0) << result.error;
    list << "[[tile]]\nfile = '" << name << "'\nyaw = " << y << "\npitch = " << p
         << "\nroll = 20\n";
  }
  list.close();
  const CommandResult result =
      runCommand({"probe", "stitch", folder / "tiles.toml", "-o", folder / "back.exr", "--size",
                  "128x64", "--same-exposure"});
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error.find("in no tile"), std::string::npos) << result.error;
  const Image back = readImage(folder / "back.exr");
  ASSERT_EQ(back.texels.size(), map.texels.size());
  for (size_t i = 0; i < map.texels.size(); ++i)
    EXPECT_NEAR(back.texels[i] / map.texels[i], 1, 0.01) << i / 3 % 128 << " " << i / 3 / 128;
}

TEST(CommandProbeCrop, NamesWhatAPngClips) {
  const TemporaryFolder folder;
  writeImage(folder / "probe.exr", constantProbe({16, 8}, Rgb(2, 0.5f, 0.5f)));
  const auto said = [&](const char* out) {
    return runCommand({"probe", "crop", folder / "probe.exr", folder / out, "--size", "8x8"}).error;
  };
  EXPECT_NE(said("a.png").find("33.3% of the channels are above 1"), std::string::npos);
  EXPECT_EQ(said("a.exr").find("above 1"), std::string::npos);
}

TEST(CommandProbeCrop, RefusesWhatIsNoView) {
  const TemporaryFolder folder;
  writeImage(folder / "probe.exr", constantProbe({16, 8}, Rgb(1)));
  const auto with = [&](const std::string& option, const std::string& value) {
    return std::vector<std::string>{"probe", "crop", folder / "probe.exr", folder / "out.exr",
                                    option,  value};
  };
  for (const char* fov : {"0", "180", "-20", "nan"}) expectError(with("--fov", fov), "--fov");
  expectError(with("--size", "0x5"), "--size");
  for (const char* angle : {"--yaw", "--pitch", "--roll"})
    for (const char* degrees : {"1e300", "-1e300", "inf", "nan"})
      expectError(with(angle, degrees), angle);
  EXPECT_EQ(runCommand(with("--yaw", "-36000")).status, 0);
  expectError({"probe", "crop", folder / "probe.exr", folder / "probe.exr"}, "probe.exr");
}

}  // namespace
}  // namespace chromeball::crop_test
