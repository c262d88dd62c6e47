// SPDX-License-Identifier: Apache-2.0
// Conversion between mappings; repair of invalid texels.
#include "probe/convert.h"

#include <gtest/gtest.h>

#include <limits>

#include "probe/edit.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "shared_data.h"

namespace chromeball::convert_test {
namespace {

constexpr std::array kMappings = {Mapping::LatLong,         Mapping::AngularMap,
                                  Mapping::MirrorBall,      Mapping::VerticalCross,
                                  Mapping::HorizontalCross, Mapping::HorizontalStrip,
                                  Mapping::VerticalStrip,   Mapping::CubeGrid};

Image onlyFilledWhereValid(Mapping mapping, const ImageSize& size, float inside, float outside) {
  Image image(size.width, size.height, 3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const dvec2 uv((x + 0.5) / size.width, (y + 0.5) / size.height);
      image.setRgb(x, y, Rgb(uvToDirection(mapping, uv) ? inside : outside));
    }
  return image;
}

// Texels outside the disc or the faces (a copyright notice, for example) do not leak in.
TEST(Convert, ConstantStaysConstant) {
  for (const Mapping from : kMappings) {
    const ImageSize size = sizeFor(from, {64, 32});
    const Image image = onlyFilledWhereValid(from, size, 0.7f, 1e6f);
    const Image latLong = convert(image, from, Mapping::LatLong, {50, 23}, 30);
    for (const float f : latLong.texels) ASSERT_NEAR(f, 0.7f, 2e-7f) << mappingName(from);
  }
  const Image latLong = constantProbe({64, 32}, Rgb(0.7f));
  for (const Mapping to : kMappings) {
    const ImageSize size = sizeFor(to, {64, 32});
    const Image image = convert(latLong, Mapping::LatLong, to, size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (uvToDirection(to, {(x + 0.5) / size.width, (y + 0.5) / size.height})) {
          ASSERT_NEAR(image.rgb(x, y).y, 0.7f, 2e-7f) << mappingName(to);
        }
  }
}

// Mean of radiance times direction, over a lat-long map.
dvec3 firstMoment(const Image& image) {
  dvec3 sum(0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      sum += double(image.rgb(x, y).x) * texelSolidAngle(y, image.width, image.height) *
             *uvToDirection(Mapping::LatLong, {(x + 0.5) / image.width, (y + 0.5) / image.height});
  return sum / (4 * kPiD);
}

TEST(Convert, PreservesTheFirstMomentOfAGradient) {
  const dvec3 slope(0.5, -0.3, 0.6);
  const Image gradient = gradientProbe({128, 64}, Rgb(2), slope);
  for (const Mapping through : kMappings) {
    const ImageSize size = sizeFor(through, {128, 64});
    const Image there = convert(gradient, Mapping::LatLong, through, size, 90);
    const Image back = convert(there, through, Mapping::LatLong, {128, 64}, -90);
    EXPECT_NEAR(meanRadiance(back).x, 2, 2e-3) << mappingName(through);
    // The mean of 2 (1 + slope . D) D is 2 slope / 3.
    EXPECT_LT(glm::distance(firstMoment(back), 2.0 / 3 * slope), 4e-3) << mappingName(through);
  }
}

// The mirror ball's texels have equal solid angles, so the mean over its square is the probe's mean
// times the disc's share of the square.
TEST(Convert, TheMeanOfAMirrorBallIsTheMeanRadiance) {
  const Image probe = gradientProbe({256, 128}, Rgb(2), {0.5, -0.3, 0.6});
  const Image ball = convert(probe, Mapping::LatLong, Mapping::MirrorBall, {1000, 1000});
  double sum = 0;
  for (const float channel : ball.texels) sum += double(channel);
  // Texels that the rim cuts have the mean of the part inside.
  EXPECT_NEAR(sum / double(ball.texels.size()) * 4 / kPiD / meanRadiance(probe).x, 1, 0.003);
}

// The integral of radiance over the sphere, from an image in any mapping.
dvec3 fluxOf(const Image& image, Mapping mapping) {
  dvec3 sum(0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const dvec2 uv((x + 0.5) / image.width, (y + 0.5) / image.height);
      if (showsDirection(mapping, uv))
        sum += dvec3(image.rgb(x, y)) * solidAngleJacobian(mapping, uv);
    }
  return sum / (double(image.width) * image.height);
}

// Lamps of one texel, a thousand times as bright as the rest.
Image manyLamps(const ImageSize& size) {
  Image image = constantProbe(size, Rgb(1));
  for (int y = 3; y < size.height - 3; ++y)
    for (int x = 0; x < size.width; ++x)
      if ((x * 7 + y * 13) % 101 == 0) image.setRgb(x, y, Rgb(1000, 500, 2000));
  return image;
}

TEST(Convert, EveryMappingKeepsTheFluxOfLamps) {
  const Image lamps = manyLamps({256, 128});
  const double expected = 4 * kPiD * meanRadiance(lamps).x;
  for (const Mapping to : kMappings) {
    const Image there = convert(lamps, Mapping::LatLong, to, sizeFor(to, {256, 128}));
    EXPECT_NEAR(fluxOf(there, to).x / expected, 1, 5e-3) << mappingName(to);
  }
}

// Converts there and back.
TEST(SlowConvert, EveryMappingKeepsTheFluxOfGraceCathedral) {
  int found = 0;
  for (const char* file : {"debevec/grace_probe.hdr", "probulator/grace_latlong_small.hdr"}) {
    const auto path = sharedData(std::string("probes/") + file);
    if (!path) continue;
    ++found;
    const Image map = loadProbe(*path).latLong;
    const dvec3 expected = 4 * kPiD * meanRadiance(map);
    for (const Mapping to : kMappings) {
      const Image there = convert(map, Mapping::LatLong, to, sizeFor(to, {map.width, map.height}));
      const Image back = latLongOf(there, to, glm::dmat3(1));
      const dvec3 ratio = fluxOf(there, to) / expected;
      const dvec3 ratioBack = 4 * kPiD * meanRadiance(back) / expected;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ratio[c], 1, 5e-3) << file << " " << mappingName(to) << " " << c;
        EXPECT_NEAR(ratioBack[c], 1, 5e-3) << file << " " << mappingName(to) << " " << c;
      }
    }
  }
  if (found == 0) GTEST_SKIP() << "no probes of Grace Cathedral";
}

TEST(Convert, SameSizeIsACopy) {
  const Image image = gradientProbe({37, 11}, Rgb(1, 2, 3), {0.1, 0.2, 0.3});
  EXPECT_EQ(convert(image, Mapping::LatLong, Mapping::LatLong, {37, 11}).texels, image.texels);
}

TEST(Convert, RotationIsCounterClockwise) {
  // It moves a light from -Z to -X.
  Image image(128, 64, 3);
  for (int y = 30; y < 34; ++y)
    for (int x = 62; x < 66; ++x) image.setRgb(x, y, Rgb(100));
  const dvec3 ahead = glm::normalize(firstMoment(image));
  EXPECT_GT(glm::dot(ahead, dvec3(0, 0, -1)), 0.9999);
  for (const Mapping through : kMappings) {
    const ImageSize size = sizeFor(through, {128, 64});
    const Image there = convert(image, Mapping::LatLong, through, size);
    const Image turned = convert(there, through, Mapping::LatLong, {128, 64}, 90);
    EXPECT_GT(glm::dot(glm::normalize(firstMoment(turned)), dvec3(-1, 0, 0)), 0.999)
        << mappingName(through);
  }
}

TEST(Convert, ShrinkingPreservesASun) {
  const Image sun = oneHotProbe({1024, 512}, 300, 200, Rgb(1e6f));
  const Image small = convert(sun, Mapping::LatLong, Mapping::LatLong, {32, 16});
  EXPECT_NEAR(meanRadiance(small).x / meanRadiance(sun).x, 1, 1e-3);
}

TEST(Repair, CountsLocatesAndReplaces) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  Image image = constantProbe({8, 4}, Rgb(1));
  image.setRgb(0, 1, Rgb(nan, 1, -infinity));
  image.setRgb(7, 1, Rgb(5));
  image.setRgb(3, 2, Rgb(1, infinity, 1));
  image.setRgb(5, 3, Rgb(-2, 3, 1));
  const RepairReport report = repair(image, true);
  EXPECT_EQ(report.nan, 1u);
  EXPECT_EQ(report.infinite, 1u);
  EXPECT_EQ(report.negative, 1u);
  EXPECT_EQ(report.firstX, 0);
  EXPECT_EQ(report.firstY, 1);
  EXPECT_TRUE(report.isBrightest);  // 3 of 5
  EXPECT_NE(describe(report).find("where it is brightest"), std::string::npos);
  EXPECT_FLOAT_EQ(image.rgb(0, 1).x, (7 * 1 + 5) / 8.0f);  // also across the seam
  EXPECT_EQ(image.rgb(3, 2), Rgb(1, 5, 1));
  EXPECT_EQ(image.rgb(5, 3), Rgb(0, 3, 1));
  EXPECT_EQ(repair(image, true).total(), 0u);

  image.setRgb(5, 3, Rgb(-2, 1, 1));
  EXPECT_FALSE(repair(image, true).isBrightest);

  Image allNan(2, 2, 3);
  std::fill(allNan.texels.begin(), allNan.texels.end(), nan);
  EXPECT_EQ(repair(allNan, true).nan, 4u);
  EXPECT_EQ(allNan.rgb(1, 1), Rgb(0));
}

// Mean of |a - b| over the sphere, divided by the mean of b, after scaling `a` to b's mean.
double relativeDifference(const Image& a, const Image& b) {
  Image difference(b.width, b.height, 3);
  const double meanB = luminance(Rgb(meanRadiance(b)));
  const float scale = float(meanB / luminance(Rgb(meanRadiance(a))));
  for (int y = 0; y < b.height; ++y)
    for (int x = 0; x < b.width; ++x)
      difference.setRgb(x, y, glm::abs(scale * a.rgb(x, y) - b.rgb(x, y)));
  return luminance(Rgb(meanRadiance(difference))) / meanB;
}

TEST(Convert, CrossAgreesWithAngularMap) {
  const auto cross = sharedData("probes/debevec/galileo_cross.hdr");
  const auto angular = sharedData("probes/debevec/galileo_probe.hdr");
  if (!cross || !angular) GTEST_SKIP() << "no probes/debevec";
  const ImageSize small{128, 64};
  const auto load = [&](const std::filesystem::path& path, Mapping expected) {
    const LoadedProbe probe = loadProbe(path);
    EXPECT_EQ(probe.mapping, expected);
    EXPECT_TRUE(probe.detected && probe.certain);
    return convert(probe.latLong, Mapping::LatLong, Mapping::LatLong, small);
  };
  const Image a = load(*cross, Mapping::VerticalCross), b = load(*angular, Mapping::AngularMap);
  EXPECT_LT(relativeDifference(a, b), 0.05);
  EXPECT_NEAR(luminance(Rgb(meanRadiance(a))) / luminance(Rgb(meanRadiance(b))), 1, 0.005);
  // Control: a rotation by 10 degrees gives a large difference.
  EXPECT_GT(relativeDifference(convert(a, Mapping::LatLong, Mapping::LatLong, small, 10), b), 0.2);
}

// The centre of a lat-long map is +Z in OpenEXR and -Z here: the loader rotates OpenEXR's maps.
TEST(Convert, StripAgreesWithOpenExrsLatLong) {
  const auto strip = sharedData("probes/openexr/StageEnvCube.exr");
  const auto latLong = sharedData("probes/openexr/StageEnvLatLong.exr");
  if (!strip || !latLong) GTEST_SKIP() << "no probes/openexr";
  const ImageSize small{128, 64};
  const Image a = convert(loadProbe(*strip).latLong, Mapping::LatLong, Mapping::LatLong, small);
  const Image b = convert(loadProbe(*latLong).latLong, Mapping::LatLong, Mapping::LatLong, small);
  EXPECT_LT(relativeDifference(a, b), 0.1);
  EXPECT_GT(relativeDifference(convert(a, Mapping::LatLong, Mapping::LatLong, small, 90), b), 0.3);
}

}  // namespace
}  // namespace chromeball::convert_test
