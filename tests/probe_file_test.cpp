// Probes from files, and what can be said of them.
#include <gtest/gtest.h>

#include "image/write.h"
#include "math/error.h"
#include "probe/info.h"
#include "probe/load.h"
#include "probe/solid_angle.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball {
namespace {

TEST(ProbeFile, LatLongOfAnyShapeKeepsItsTexels) {
  const TemporaryFolder folder;
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {3, 2}, {1, 2}, {5, 5}, {64, 32}}) {
    const Image image = gradientProbe({w, h}, Rgb(1, 2, 3), {0.2, 0.3, 0.4});
    writeImage(folder / "p.exr", image);
    const LoadedProbe probe = loadProbe(folder / "p.exr");
    EXPECT_EQ(probe.latLong.texels, image.texels) << w << " x " << h;
    EXPECT_TRUE(probe.guessed);
    EXPECT_FALSE(probe.reason.empty());
  }
}

TEST(ProbeFile, GivenMappingWins) {
  const TemporaryFolder folder;
  writeImage(folder / "p.exr", constantProbe({32, 32}, Rgb(1)));
  const LoadedProbe latLong = loadProbe(folder / "p.exr", "lat-long");
  EXPECT_EQ(latLong.latLong.width, 32);
  EXPECT_FALSE(latLong.guessed);
  const LoadedProbe ball = loadProbe(folder / "p.exr", "mirror-ball");
  EXPECT_EQ(ball.latLong.width, 2 * ball.latLong.height);
  EXPECT_THROW(loadProbe(folder / "p.exr", "cube-cross"), InputError);
  EXPECT_THROW(loadProbe(folder / "p.exr", "sphere"), InputError);
}

TEST(ProbeFile, InvalidTexelsAreRepairedAndReported) {
  const TemporaryFolder folder;
  Image image = constantProbe({16, 8}, Rgb(1));
  image.setRgb(4, 3, Rgb(std::nanf("")));
  image.setRgb(5, 6, Rgb(-1));
  writeImage(folder / "p.exr", image);
  const LoadedProbe probe = loadProbe(folder / "p.exr");
  EXPECT_EQ(probe.repair.nan, 1u);
  EXPECT_EQ(probe.repair.negative, 1u);
  EXPECT_EQ(probe.latLong.rgb(4, 3), Rgb(1));
  const std::vector<std::string> lines = warnings(probe, "p.exr");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("(4, 3)"), std::string::npos) << lines[0];
}

TEST(ProbeInfo, OneTexel) {
  const int w = 64, h = 32;
  const ProbeInfo info = probeInfo(oneHotProbe({w, h}, 40, 9, Rgb(1000, 2000, 500)));
  const double solidAngle = texelSolidAngle(9, w, h);
  EXPECT_NEAR(info.meanRadiance.y, 2000 * solidAngle / (4 * kPiD), 1e-9);
  EXPECT_EQ(info.max, Rgb(1000, 2000, 500));
  EXPECT_EQ(info.min, Rgb(0));
  EXPECT_EQ(info.brightestShares.front().share, 1);
  ASSERT_EQ(info.suns.size(), 1u);
  EXPECT_NEAR(info.suns[0].irradiance.x / (1000 * solidAngle), 1, 1e-3);
  EXPECT_LT(glm::distance(info.suns[0].direction, info.brightestDirection), 1e-3);
  // About the disc of the texel's solid angle.
  EXPECT_NEAR(info.suns[0].angle / (std::sqrt(4 / kPiD * solidAngle) * 180 / kPiD), 1, 0.05);
}

TEST(ProbeInfo, ConstantAndBlack) {
  const ProbeInfo constant = probeInfo(constantProbe({30, 20}, Rgb(0.5f)));
  EXPECT_NEAR(constant.meanRadiance.z, 0.5, 1e-12);
  EXPECT_NEAR(constant.dynamicRange, 1, 1e-6);
  EXPECT_TRUE(constant.suns.empty());
  const ProbeInfo black = probeInfo(constantProbe({30, 20}, Rgb(0)));
  EXPECT_EQ(black.dynamicRange, 0);
  EXPECT_EQ(black.brightestShares.front().share, 0);
  EXPECT_TRUE(black.suns.empty());
}

}  // namespace
}  // namespace chromeball
