// Probes from files, and what can be said of them.
#include <gtest/gtest.h>

#include "image/write.h"
#include "math/error.h"
#include "probe/info.h"
#include "probe/load.h"
#include "probe/solid_angle.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

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
  EXPECT_NEAR(info.suns[0].irradiance.x, 1000 * solidAngle, 1e-9);
  EXPECT_LT(glm::distance(info.suns[0].direction, info.brightestDirection), 1e-9);
  // The disc of the texel's solid angle: about 5.6 degrees x 5.6 x sin(theta).
  EXPECT_NEAR(info.suns[0].angularDiameter, std::sqrt(4 / kPiD * solidAngle) * 180 / kPiD, 0.01);
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

TEST(ProbeInfo, SunOverTheSeamIsOne) {
  Image image = constantProbe({128, 64}, Rgb(0.01f));
  for (const int x : {127, 0}) image.setRgb(x, 20, Rgb(1e5f));
  EXPECT_EQ(findSuns(image).size(), 1u);
  image.setRgb(64, 20, Rgb(1e5f));
  EXPECT_EQ(findSuns(image).size(), 2u);
}

// The same numbers from an independent program (numpy), stated beside the data.
TEST(ProbeInfo, RealSuns) {
  const auto spot = sharedData("probes/synthetic/spot1Lux.hdr");
  const auto sunrise = sharedData("probes/polyhaven/pmndrs_sunrise.hdr");
  if (!spot || !sunrise) GTEST_SKIP() << "no probes";
  const auto spotSuns = findSuns(loadProbe(*spot).latLong);
  ASSERT_EQ(spotSuns.size(), 1u);
  EXPECT_NEAR(spotSuns[0].irradiance.x, 0.9592, 1e-4);
  const auto suns = findSuns(loadProbe(*sunrise).latLong);
  ASSERT_GE(suns.size(), 1u);
  EXPECT_NEAR(luminance(Rgb(suns[0].irradiance)), 12.4, 0.1);
  EXPECT_NEAR(std::asin(suns[0].direction.y) * 180 / kPiD, 7.9, 0.3);
}

}  // namespace
}  // namespace chromeball
